# How the folders of base/, compiler/ and workbench/ are built.

# Headers that most files include are compiled once per build. Every file still includes the headers
# that it uses, which tests/house checks.
option(ETLC_PRECOMPILE "Read the headers that most files include once a build" ON)
mark_as_advanced(ETLC_PRECOMPILE)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Debug")
  # With a precompiled header, GCC 12 has __OPTIMIZE__ defined in some files even without -O. Then
  # Eigen does not compile, and the runtime's namespace has two names.
  set(ETLC_PRECOMPILE OFF)
endif()

# One static library per folder, `etlc_<folder>`; DEPENDS lists the stages that it builds on, as in
# docs/contributing/compiler.md. Include paths start below the layer: base/source is included as
# source/.
add_library(etlc_options INTERFACE)
set(shadow -Wshadow)
if(CMAKE_UNITY_BUILD)
  # Sources that are compiled as one see each other's unnamed namespaces: what is local may have
  # the name of a constant in another file, and a struct may have members of such a namespace.
  set(shadow "$<$<CXX_COMPILER_ID:GNU>:-Wshadow=local;-Wno-subobject-linkage>")
endif()
target_compile_options(etlc_options INTERFACE
  -Wall -Wextra -Wno-missing-field-initializers ${shadow} -Wpedantic -Wconversion
  -Wno-sign-conversion
  # GCC 12 sees overlaps in `"text" + string` that are not there.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # These let ccache see precompiled headers.
  $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>
  "$<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>"
  -ffp-contract=off)  # constants are the same on every machine
# etlc compiles a spec in milliseconds, so more than -O1 would only slow down its build. Code that
# processes recordings frame by frame is the exception: see LOOPS of etlc_stage.
target_compile_options(etlc_options INTERFACE $<$<CONFIG:Release>:-O1>)
if(ETLC_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 forgets which precompiled headers are the system's, and gives false warnings about
  # std::string.
  target_compile_options(etlc_options INTERFACE
    -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
endif()
if(CMAKE_CXX_FLAGS MATCHES "fsanitize")
  # One version of the kernels instead of one per instruction set: tests/runtime covers them all.
  target_compile_definitions(etlc_options INTERFACE ETLMON_NO_DISPATCH)
endif()
if(ETLC_WERROR)
  target_compile_options(etlc_options INTERFACE -Werror)
endif()

# All of it may go into libetlc.so, which exports only its own functions.
set(ETLC_LIKE_LIBETLC POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
  VISIBILITY_INLINES_HIDDEN ON)

set(ETLC_NO_CODE ${PROJECT_BINARY_DIR}/no_code.cpp CACHE INTERNAL "A library has a source")
file(CONFIGURE OUTPUT ${ETLC_NO_CODE} CONTENT "// For the sake of precompiled headers.\n")
add_library(etlc_precompiled OBJECT ${ETLC_NO_CODE})
target_link_libraries(etlc_precompiled PUBLIC etlc_options fmt::fmt)
set_target_properties(etlc_precompiled PROPERTIES ${ETLC_LIKE_LIBETLC})
if(ETLC_PRECOMPILE)
  target_precompile_headers(etlc_precompiled PRIVATE
    <algorithm> <array> <cmath> <cstdint> <functional> <map> <memory> <optional> <set> <string>
    <string_view> <unordered_map> <variant> <vector> <fmt/format.h>)
endif()

# Code that processes recordings frame by frame is optimised fully.
add_library(etlc_optimised INTERFACE)
target_compile_options(etlc_optimised INTERFACE $<$<CONFIG:Release>:-O3>)
target_link_libraries(etlc_optimised INTERFACE etlc_options)

# etlc_stage(NAME SOURCES file... [LOOPS file...] [DEPENDS stage...] [LIBRARIES target...]). LOOPS:
# the sources that process recordings frame by frame. OWN_HEADERS: the stage has other options than
# the rest, so it cannot share precompiled headers.
function(etlc_stage name)
  cmake_parse_arguments(PARSE_ARGV 1 STAGE "OWN_HEADERS" "" "SOURCES;LOOPS;DEPENDS;LIBRARIES")
  list(TRANSFORM STAGE_DEPENDS PREPEND etlc_)
  add_library(etlc_${name} STATIC ${STAGE_SOURCES})
  etlc_part_of_stage(etlc_${name} ${STAGE_LIBRARIES} ${STAGE_DEPENDS})
  if(ETLC_PRECOMPILE AND NOT STAGE_OWN_HEADERS)
    target_precompile_headers(etlc_${name} REUSE_FROM etlc_precompiled)
  endif()
  if(STAGE_LOOPS)
    add_library(etlc_${name}_loops OBJECT ${STAGE_LOOPS})
    etlc_part_of_stage(etlc_${name}_loops ${STAGE_LIBRARIES} ${STAGE_DEPENDS} etlc_optimised)
    target_sources(etlc_${name} PRIVATE $<TARGET_OBJECTS:etlc_${name}_loops>)
  endif()
endfunction()

# etlc_part_of_stage(TARGET library...): what the libraries of a stage have in common.
function(etlc_part_of_stage target)
  target_link_libraries(${target} PUBLIC etlc_options fmt::fmt ${ARGN})
  file(RELATIVE_PATH layer ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  string(REGEX REPLACE "/.*" "" layer ${layer})
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR}/${layer})
  set_target_properties(${target} PROPERTIES ${ETLC_LIKE_LIBETLC})
endfunction()
