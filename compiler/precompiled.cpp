// Compiled for its precompiled headers alone: compiler/CMakeLists.txt lists them.
