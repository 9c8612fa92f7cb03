# Writes OUTPUT, a C++ source that holds the files of RUNTIME (an include folder) as text, for the
# function SPACE::FUNCTION, which INCLUDE declares: --standalone pastes them, or etlc prove compiles
# them.
file(GLOB_RECURSE headers RELATIVE "${RUNTIME}" "${RUNTIME}/*.hpp" "${RUNTIME}/*.inc")
set(source "#include \"${INCLUDE}\"\n\nnamespace ${SPACE} {\n\n")
string(APPEND source
  "const std::vector<RuntimeFile>& ${FUNCTION}() {\n"
  "    static const std::vector<RuntimeFile> files = {\n")
foreach(header IN LISTS headers)
  file(READ "${RUNTIME}/${header}" text)
  string(APPEND source "        {\"${header}\", R\"etlmon(${text})etlmon\"},\n")
endforeach()
string(APPEND source "    };\n    return files;\n}\n\n}  // namespace ${SPACE}\n")
file(WRITE "${OUTPUT}" "${source}")
