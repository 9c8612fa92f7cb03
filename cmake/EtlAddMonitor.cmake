# etlc_add_monitor(TARGET SPEC file [THRESHOLDS file] [FITTED file] [EMBEDDED file]
#                  [VALUES robustness|boolean] [NAMESPACE name] [INLINE_TARGETS bytes]
#                  [RECORDER before,after,incidents] [EXPLAIN] [LETS] [RETARGETABLE] [STANDALONE]
#                  [SET name=value ...])
#
# Compiles an Embedding Temporal Logic spec into the header <stem of SPEC>.hpp, which the sources of
# TARGET then include by that name.
#   TARGET          an executable or a library made in this directory; it may have several monitors
#   SPEC            the .etl file
#   THRESHOLDS      the thresholds file; default: SPEC.thresholds.json beside the spec, if it exists
#   FITTED          the file of `etlc fit`; default: SPEC.fitted.npz beside the spec, if it exists
#   EMBEDDED        the file of `etlc embed`; default: SPEC.embedded.npz beside the spec
#   VALUES          the values of the monitors: robustness (the default) or boolean, which are truth
#                   values and measure only distances that can change a verdict
#   NAMESPACE       the namespace of the generated code; default: the name after `spec`
#   SET             other values for constants of the spec: SET limit=0.25 deadline=2s
#   STANDALONE      the header contains the runtime; without it TARGET is linked with
#                   etlmon::etlmon. A source must not include both kinds.
#   INLINE_TARGETS  larger target sets go to <stem of SPEC>.targets.bin beside the header; default:
#                   262144. The program gives the monitor that file, which is empty if no set is
#                   larger. The property ETLC_TARGETS_FILES of TARGET lists these files.
#   RECORDER        keeps the steps around alarms, for `etlc incident`: RECORDER 2s,1s,4
#   EXPLAIN         the class names the sample that decides a verdict: why_NAME(); not with VALUES
#                   boolean
#   LETS            telemetry for the lets of the spec: let_NAME(), robustness_NAME()
#   RETARGETABLE    the numbers of the spec are in <stem of SPEC>.params.bin beside the header, and
#                   can be replaced at run time; not with INLINE_TARGETS, RECORDER, EXPLAIN or
#                   VALUES boolean. The property ETLC_PARAMS_FILES of TARGET lists these files.
# Relative paths are relative to the current source directory. The header is in the build folder
# and is made again when the spec, a file that it loads, the thresholds, the fitted or embedded
# files, or etlc itself change. Names of files and folders must not contain ; \ ' " & # * < > | : =
# ? ^ ` $ or a square bracket, and those of the spec and the build folder no %. For a library, the
# header and the runtime are public. Needs CMake 3.20 and the Ninja or Makefile generators (3.21 for
# the others).
cmake_policy(PUSH)
cmake_policy(VERSION 3.20)

function(etlc_add_monitor target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "EXPLAIN;LETS;RETARGETABLE;STANDALONE"
    "SPEC;THRESHOLDS;FITTED;EMBEDDED;VALUES;NAMESPACE;INLINE_TARGETS;RECORDER" "SET")
  set(call "etlc_add_monitor(${target})")

  if(arg_UNPARSED_ARGUMENTS)
    list(JOIN arg_UNPARSED_ARGUMENTS " " unknown)
    message(FATAL_ERROR "${call}: unknown arguments: ${unknown}")
  endif()
  if(arg_KEYWORDS_MISSING_VALUES)
    list(JOIN arg_KEYWORDS_MISSING_VALUES " " valueless)
    message(FATAL_ERROR "${call}: no value after: ${valueless}")
  endif()
  if(NOT arg_SPEC)
    message(FATAL_ERROR "${call}: SPEC is missing")
  endif()
  set(name "[A-Za-z_][A-Za-z0-9_]*")
  if(arg_NAMESPACE AND NOT arg_NAMESPACE MATCHES "^${name}(::${name})*$")
    message(FATAL_ERROR "${call}: NAMESPACE ${arg_NAMESPACE} is not a C++ namespace")
  endif()
  if(arg_VALUES AND NOT arg_VALUES MATCHES "^(robustness|boolean)$")
    message(FATAL_ERROR "${call}: VALUES ${arg_VALUES}: expected robustness or boolean")
  endif()
  if(arg_EXPLAIN AND "${arg_VALUES}" STREQUAL "boolean")
    message(FATAL_ERROR "${call}: EXPLAIN follows robustness, which VALUES boolean has none of")
  endif()
  if(arg_RETARGETABLE AND (arg_EXPLAIN OR arg_RECORDER OR DEFINED arg_INLINE_TARGETS
                           OR "${arg_VALUES}" STREQUAL "boolean"))
    message(FATAL_ERROR
      "${call}: RETARGETABLE goes without EXPLAIN, RECORDER, INLINE_TARGETS and VALUES boolean")
  endif()
  if(DEFINED arg_INLINE_TARGETS AND NOT arg_INLINE_TARGETS MATCHES "^[0-9]+$")
    message(FATAL_ERROR "${call}: INLINE_TARGETS ${arg_INLINE_TARGETS}: expected a number of bytes")
  endif()
  __etlc_check_target("${call}" "${target}")
  __etlc_input("${call}" SPEC "${arg_SPEC}" spec)

  get_filename_component(stem "${spec}" NAME_WLE)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/etlc/${target}")
  set(header "${folder}/${stem}.hpp")
  __etlc_check_name("${call}" "the header" "${header}")
  if(header MATCHES "%")  # a pattern, to Make
    message(FATAL_ERROR "${call}: the header ${header}: a name with % in it, which "
                        "not all build tools read alike: rename the file or its folder")
  endif()
  get_target_property(monitors ${target} ETLC_MONITORS)
  if("${stem}" IN_LIST monitors)
    message(FATAL_ERROR
      "${call}: there is a monitor ${stem}.hpp already: name one of the two specs otherwise")
  endif()
  set_property(TARGET ${target} APPEND PROPERTY ETLC_MONITORS "${stem}")
  if(arg_RETARGETABLE)
    set(beside "${folder}/${stem}.params.bin")
    set_property(TARGET ${target} APPEND PROPERTY ETLC_PARAMS_FILES "${beside}")
    set(options --retargetable)
  else()
    set(beside "${folder}/${stem}.targets.bin")
    set_property(TARGET ${target} APPEND PROPERTY ETLC_TARGETS_FILES "${beside}")
    set(options --targets-file "${beside}")
  endif()

  set(depends "${spec}")
  if(arg_THRESHOLDS)
    __etlc_input("${call}" THRESHOLDS "${arg_THRESHOLDS}" thresholds)
    list(APPEND options --thresholds "${thresholds}")
    list(APPEND depends "${thresholds}")
  endif()
  if(arg_FITTED)
    __etlc_input("${call}" FITTED "${arg_FITTED}" fitted)
    list(APPEND options --fitted "${fitted}")
    list(APPEND depends "${fitted}")
  endif()
  if(arg_EMBEDDED)
    __etlc_input("${call}" EMBEDDED "${arg_EMBEDDED}" embedded)
    list(APPEND options --embedded "${embedded}")
    list(APPEND depends "${embedded}")
  endif()
  if(arg_VALUES)
    list(APPEND options --values ${arg_VALUES})
  endif()
  if(arg_NAMESPACE)
    list(APPEND options --namespace ${arg_NAMESPACE})
  endif()
  if(DEFINED arg_INLINE_TARGETS)
    list(APPEND options --inline-targets ${arg_INLINE_TARGETS})
  endif()
  if(arg_RECORDER)
    list(APPEND options --recorder "${arg_RECORDER}")
  endif()
  if(arg_EXPLAIN)
    list(APPEND options --explain)
  endif()
  if(arg_LETS)
    list(APPEND options --lets)
  endif()
  if(arg_STANDALONE)
    list(APPEND options --standalone)
  endif()
  foreach(setting IN LISTS arg_SET)
    list(APPEND options --set ${setting})
  endforeach()

  file(MAKE_DIRECTORY "${folder}")
  add_custom_command(
    OUTPUT "${header}" "${beside}"
    COMMAND etlc::etlc "${spec}" -o "${header}" --depfile "${header}.d" ${options}
    DEPENDS ${depends} etlc::etlc
    DEPFILE "${header}.d"
    COMMENT "Compiling ${stem}.etl to ${stem}.hpp"
    VERBATIM)

  get_target_property(type ${target} TYPE)
  if(type STREQUAL "EXECUTABLE")
    set(scope PRIVATE)
  else()
    set(scope PUBLIC)
  endif()
  target_sources(${target} PRIVATE "${header}")
  target_include_directories(${target} ${scope} "$<BUILD_INTERFACE:${folder}>")
  if(arg_STANDALONE)
    target_compile_features(${target} ${scope} cxx_std_17)
  else()
    target_link_libraries(${target} ${scope} etlmon::etlmon)
  endif()
endfunction()

# Stops unless sources can be added to `target`.
function(__etlc_check_target call target)
  if(NOT TARGET ${target})
    message(FATAL_ERROR
      "${call}: there is no target ${target}: call add_executable or add_library first")
  endif()
  get_target_property(aliased ${target} ALIASED_TARGET)
  get_target_property(imported ${target} IMPORTED)
  get_target_property(type ${target} TYPE)
  if(aliased OR imported OR NOT type MATCHES "^(EXECUTABLE|(STATIC|SHARED|MODULE|OBJECT)_LIBRARY)$")
    message(FATAL_ERROR
      "${call}: ${target} is neither an executable nor a library that compiles sources")
  endif()
  get_target_property(home ${target} SOURCE_DIR)
  if(NOT home STREQUAL CMAKE_CURRENT_SOURCE_DIR)
    message(FATAL_ERROR
      "${call}: ${target} was made in ${home}: call this there, "
      "since a build rule belongs to its directory")
  endif()
endfunction()

# Returns the absolute path of a file that exists or that the build makes.
function(__etlc_input call keyword path result)
  __etlc_check_name("${call}" ${keyword} "${path}")
  get_filename_component(absolute "${path}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_SOURCE_DIR}")
  get_source_file_property(generated "${absolute}" GENERATED)
  if(NOT generated AND (NOT EXISTS "${absolute}" OR IS_DIRECTORY "${absolute}"))
    message(FATAL_ERROR "${call}: ${keyword} ${path}: there is no such file: ${absolute}")
  endif()
  __etlc_check_name("${call}" ${keyword} "${absolute}")
  set(${result} "${absolute}" PARENT_SCOPE)
endfunction()

# Stops at a name with a character that CMake, Make, Ninja and depfiles read differently.
function(__etlc_check_name call what name)
  string(REPLACE "\\;" ";" name "${name}")  # as cmake_parse_arguments writes it
  string(REGEX REPLACE "^[A-Za-z]:" "" rest "${name}")  # a drive
  if(rest MATCHES "[];['\"&#*<>|:=?^`$\\]")
    message(FATAL_ERROR "${call}: ${what} ${name}: a name with ${CMAKE_MATCH_0} in it, "
                        "which not all build tools read alike: rename the file or its folder")
  endif()
endfunction()

cmake_policy(POP)
