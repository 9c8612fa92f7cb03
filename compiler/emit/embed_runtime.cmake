# Writes OUTPUT, a C++ source that holds the files of RUNTIME (its include folder) as text: what
# --standalone pastes.
file(GLOB_RECURSE headers
  RELATIVE "${RUNTIME}" "${RUNTIME}/etlmon/*.hpp" "${RUNTIME}/etlmon/*.inc")
set(source "#include \"emit/standalone.hpp\"\n\nnamespace etlc::emit {\n\n")
string(APPEND source
  "const std::vector<RuntimeFile>& runtime_files() {\n"
  "    static const std::vector<RuntimeFile> files = {\n")
foreach(header IN LISTS headers)
  file(READ "${RUNTIME}/${header}" text)
  string(APPEND source "        {\"${header}\", R\"etlmon(${text})etlmon\"},\n")
endforeach()
string(APPEND source "    };\n    return files;\n}\n\n}  // namespace etlc::emit\n")
file(WRITE "${OUTPUT}" "${source}")
