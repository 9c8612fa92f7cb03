# The temporal operators, and adaptive thresholds: with sanitizers, then with flags or a compiler
# that could change the meaning of floats. Windows and formulas use only integers, so testing them
# with the sanitizers is enough.
etlc_joined(float_sources temporal_floats
  test_adaptation.cpp test_past.cpp test_recorder.cpp test_stale.cpp test_temporal_truth.cpp
  test_temporal_values.cpp)
etlc_joined(integer_sources temporal_integers test_temporal_costs.cpp test_temporal_count.cpp
  test_temporal_formulas.cpp)
list(APPEND integer_sources ${CMAKE_CURRENT_SOURCE_DIR}/test_temporal_windows.cpp)
set(temporal_warnings -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wpedantic -Werror)

# etlc_temporal_variant(NAME SOURCES file... OPTIONS option...): adds them as one test.
function(etlc_temporal_variant name)
  cmake_parse_arguments(PARSE_ARGV 1 VARIANT "" "" "SOURCES;OPTIONS")
  add_executable(${name} ${VARIANT_SOURCES})
  set_target_properties(${name} PROPERTIES CXX_STANDARD 17)
  target_compile_options(${name} PRIVATE ${temporal_warnings} ${VARIANT_OPTIONS})
  target_link_options(${name} PRIVATE ${VARIANT_OPTIONS})
  target_link_libraries(${name} PRIVATE etlmon::etlmon GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name} --gtest_brief=1)
endfunction()
etlc_temporal_variant(test_temporal
  SOURCES ${float_sources} ${integer_sources} OPTIONS ${quick_sanitizers_gcc})
etlc_quick(test_temporal)
etlc_temporal_variant(test_temporal_fast_math SOURCES ${float_sources} OPTIONS -O2 -ffast-math)

# The compiler that does not build the project, with its most aggressive flags.
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  set(temporal_other g++)
else()
  set(temporal_other clang++)
endif()
find_program(ETLC_TEMPORAL_OTHER ${temporal_other})
mark_as_advanced(ETLC_TEMPORAL_OTHER)
if(NOT ETLC_TEMPORAL_OTHER)
  string(REPLACE "clang++" "clang" temporal_package ${temporal_other})
  etlc_missing_tool(${temporal_other} ${temporal_package})
else()
  file(GLOB temporal_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/runtime/include/etlmon/temporal/*
    ${PROJECT_SOURCE_DIR}/runtime/include/etlmon/past/*
    ${CMAKE_CURRENT_SOURCE_DIR}/*.hpp ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  set(objects)
  foreach(source ${float_sources})
    get_filename_component(object ${source} NAME)
    set(object other_${object}.o)
    add_custom_command(OUTPUT ${object}
      COMMAND ${CMAKE_CXX_COMPILER_LAUNCHER} ${ETLC_TEMPORAL_OTHER} -std=c++17 -O2 -ffast-math
              ${temporal_warnings} -I${PROJECT_SOURCE_DIR}/runtime/include
              -c ${source} -o ${object}
      DEPENDS ${source} ${temporal_files} VERBATIM)
    list(APPEND objects ${object})
  endforeach()
  add_custom_command(OUTPUT test_temporal_other_compiler
    COMMAND ${ETLC_TEMPORAL_OTHER} -ffast-math ${objects} $<TARGET_FILE:GTest::gtest_main>
            $<TARGET_FILE:GTest::gtest> -lpthread -o test_temporal_other_compiler
    DEPENDS ${objects} VERBATIM)
  add_custom_target(temporal_other_compiler ALL DEPENDS test_temporal_other_compiler)
  add_test(NAME test_temporal_other_compiler
    COMMAND ${CMAKE_CURRENT_BINARY_DIR}/test_temporal_other_compiler --gtest_brief=1)
endif()
