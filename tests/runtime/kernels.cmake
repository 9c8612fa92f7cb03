# Distances, aggregates, views and expressions: with the project's flags, then with flags and a
# compiler that could change them.
find_package(Eigen3 REQUIRED)
etlc_joined(checks kernel_checks
  test_between.cpp test_distances.cpp test_enclosed.cpp test_expression.cpp test_not_finite.cpp
  test_views.cpp)
set(here ${CMAKE_CURRENT_SOURCE_DIR})
set(kernel_sources ${here}/row_kernels_f32.cpp ${checks})
set(twins ${here}/test_kernel_twins.cpp)
etlc_joined(narrow_checks kernel_narrow_checks
  test_kernel_versions.cpp test_narrow_halves.cpp test_narrow_bytes.cpp)
set(narrow_sources ${here}/row_kernels_f16.cpp ${here}/row_kernels_i8.cpp ${narrow_checks})
set(kernel_warnings -Wall -Wextra -Wconversion -Wno-sign-conversion -Wshadow -Wpedantic -Werror)

# The oracle is built once, without the flags under test.
add_library(exact_distances STATIC exact.cpp)
target_link_libraries(exact_distances PUBLIC etlmon::etlmon PRIVATE Eigen3::Eigen)
target_compile_options(exact_distances PRIVATE -O2)

etlc_test(test_kernels RUNTIME
  SOURCES ${kernel_sources} ${twins} ${narrow_sources}
  LIBRARIES exact_distances)
target_compile_options(test_kernels PRIVATE ${kernel_warnings} -O2)

if(CMAKE_CXX_FLAGS MATCHES "fsanitize")
  return()  # the variants would repeat tests of the release build
endif()

# etlc_kernel_variant(NAME SOURCES file... OPTIONS option...): adds them as one test.
function(etlc_kernel_variant name)
  cmake_parse_arguments(PARSE_ARGV 1 VARIANT "" "" "SOURCES;OPTIONS")
  add_executable(${name} ${VARIANT_SOURCES})
  set_target_properties(${name} PROPERTIES CXX_STANDARD 17)
  target_compile_options(${name} PRIVATE ${kernel_warnings} ${VARIANT_OPTIONS})
  target_link_options(${name} PRIVATE ${VARIANT_OPTIONS})
  target_link_libraries(${name} PRIVATE exact_distances GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name} --gtest_brief=1)
endfunction()
# Assumptions about floats, with the compiler's own vectors. Random specs in test_monitors have
# kernels of compile-time sizes with these flags.
etlc_kernel_variant(test_kernels_fast_math
  SOURCES ${kernel_sources} OPTIONS -O2 -ffast-math -DETLMON_NO_DISPATCH)
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  return()
endif()
# The single version of a unit compiled for this CPU, at every size. test_kernels checks that
# versions give equal bits.
etlc_kernel_variant(test_kernels_native
  SOURCES row_kernels_f32.cpp test_distances.cpp OPTIONS -O2 -march=native)
# As on firmware: no vectors, no compiler extensions, and code optimised for size.
etlc_kernel_variant(test_kernels_small
  SOURCES ${kernel_sources} ${twins} ${narrow_sources}
  OPTIONS -Os -DETLMON_PORTABLE)
# Only the baseline: in the other versions, guarded.hpp detects loads past the end of a row. Twins
# measure the same rows, and monitor.narrow_targets has narrow ones.
etlc_kernel_variant(test_kernels_sanitized
  SOURCES ${kernel_sources} OPTIONS ${quick_sanitizers_gcc} -DETLMON_NO_DISPATCH)
set_tests_properties(test_kernels_sanitized PROPERTIES COST 80)
set_tests_properties(test_kernels_small PROPERTIES COST 35)

# What objects by custom commands depend on.
file(GLOB_RECURSE kernel_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/runtime/include/etlmon/*
  ${here}/*.hpp ${here}/*.cpp)
# The other compiler with its most aggressive flags, and every header alone with both.
find_program(ETLC_CLANG clang++)
mark_as_advanced(ETLC_CLANG)
set(kernel_compilers ${CMAKE_CXX_COMPILER})
if(NOT ETLC_CLANG)
  etlc_missing_tool(clang++ clang)
else()
  list(APPEND kernel_compilers ${ETLC_CLANG})
  set(objects)
  foreach(source ${kernel_sources})
    get_filename_component(object ${source} NAME)
    set(object clang_${object}.o)
    add_custom_command(OUTPUT ${object}
      COMMAND ${CMAKE_CXX_COMPILER_LAUNCHER} ${ETLC_CLANG} -std=c++17 -O2 -ffast-math
              -DETLMON_NO_DISPATCH ${kernel_warnings} -I${PROJECT_SOURCE_DIR}/runtime/include
              -c ${source} -o ${object}
      DEPENDS ${source} ${kernel_files} VERBATIM)
    list(APPEND objects ${object})
  endforeach()
  add_custom_command(OUTPUT test_kernels_clang_fast_math
    COMMAND ${ETLC_CLANG} -ffast-math ${objects} $<TARGET_FILE:exact_distances>
            $<TARGET_FILE:GTest::gtest_main> $<TARGET_FILE:GTest::gtest> -lpthread
            -o test_kernels_clang_fast_math
    DEPENDS ${objects} exact_distances VERBATIM)
  add_custom_target(kernels_clang_fast_math ALL DEPENDS test_kernels_clang_fast_math)
  add_test(NAME test_kernels_clang_fast_math
    COMMAND ${CMAKE_CURRENT_BINARY_DIR}/test_kernels_clang_fast_math --gtest_brief=1)
endif()
include(aarch64.cmake)
foreach(compiler IN LISTS kernel_compilers)
  get_filename_component(name ${compiler} NAME)
  add_test(NAME runtime_headers.${name}
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/headers.sh ${PROJECT_SOURCE_DIR} ${compiler})
  set_tests_properties(runtime_headers.${name} PROPERTIES COST 50)
endforeach()
