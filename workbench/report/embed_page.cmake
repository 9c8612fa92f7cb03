# Writes OUTPUT, a C++ source that holds the files of a page, with their hashes for the page's
# Content-Security-Policy: FILES and SCRIPTS, which are relative to FOLDER; the scripts are one
# program, page.js. With D3, also the chart library. NAMESPACE is that of the stage.
function(add_file name text)
  string(SHA256 hash "${text}")
  string(APPEND files "        {\"${name}\", \"${hash}\",\n"
    "         R\"etlc_page(${text})etlc_page\"},\n")
  set(files "${files}" PARENT_SCOPE)
endfunction()

set(files "")
foreach(name IN LISTS FILES)
  file(READ "${FOLDER}/${name}" text)
  add_file(${name} "${text}")
endforeach()
set(text "\"use strict\";\n")
foreach(name IN LISTS SCRIPTS)
  file(READ "${FOLDER}/${name}" script)
  string(APPEND text "${script}")
endforeach()
add_file(page.js "${text}")
if(D3)
  file(READ "${D3}" text)
  add_file(d3.js "${text}")
endif()

file(WRITE "${OUTPUT}" "#include \"report/document.hpp\"

// C++ compilers need not support strings as long as these.
#pragma GCC diagnostic ignored \"-Woverlength-strings\"

namespace etlc::${NAMESPACE} {

const std::vector<etlc::report::PageFile>& page_files() {
    static const std::vector<etlc::report::PageFile> files = {
${files}    };
    return files;
}

}  // namespace etlc::${NAMESPACE}
")
