# The temporal operators, and thresholds that move: as the project is built, then where flags or
# another compiler could change what they mean.
set(temporal_sources test_adaptation.cpp test_temporal_costs.cpp test_temporal_formulas.cpp
  test_temporal_truth.cpp test_temporal_values.cpp test_temporal_windows.cpp)
set(temporal_warnings -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wpedantic -Werror)

etlc_test(test_temporal RUNTIME SOURCES ${temporal_sources} LIBRARIES etlmon::etlmon)
target_compile_options(test_temporal PRIVATE ${temporal_warnings} -O2)

# etlc_temporal_variant(NAME option...): the same tests under these options, as one test.
function(etlc_temporal_variant name)
  add_executable(${name} ${temporal_sources})
  set_target_properties(${name} PROPERTIES CXX_STANDARD 17)
  target_compile_options(${name} PRIVATE ${temporal_warnings} ${ARGN})
  target_link_options(${name} PRIVATE ${ARGN})
  target_link_libraries(${name} PRIVATE etlmon::etlmon GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name} --gtest_brief=1)
endfunction()
etlc_temporal_variant(test_temporal_sanitized ${quick_sanitizers_gcc})
# Windows and formulas work on integers alone; here are the floats that become them.
set(temporal_sources_all ${temporal_sources})
set(temporal_sources test_adaptation.cpp test_temporal_values.cpp)
etlc_temporal_variant(test_temporal_fast_math -O3 -ffast-math)
set(temporal_sources ${temporal_sources_all})

# The compiler that the project is not built with, at its boldest.
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
  set(temporal_headers ${CMAKE_CURRENT_SOURCE_DIR}/temporal_streams.hpp)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/runtime/include/etlmon/temporal/*)
  list(APPEND temporal_headers ${headers})
  set(objects)
  foreach(source ${temporal_sources})
    add_custom_command(OUTPUT other_${source}.o
      COMMAND ${CMAKE_CXX_COMPILER_LAUNCHER} ${ETLC_TEMPORAL_OTHER} -std=c++17 -O3 -ffast-math
              ${temporal_warnings} -I${PROJECT_SOURCE_DIR}/runtime/include
              -c ${CMAKE_CURRENT_SOURCE_DIR}/${source} -o other_${source}.o
      DEPENDS ${source} ${temporal_headers} VERBATIM)
    list(APPEND objects other_${source}.o)
  endforeach()
  add_custom_command(OUTPUT test_temporal_other_compiler
    COMMAND ${ETLC_TEMPORAL_OTHER} -ffast-math ${objects} $<TARGET_FILE:GTest::gtest_main>
            $<TARGET_FILE:GTest::gtest> -lpthread -o test_temporal_other_compiler
    DEPENDS ${objects} VERBATIM)
  add_custom_target(temporal_other_compiler ALL DEPENDS test_temporal_other_compiler)
  add_test(NAME test_temporal_other_compiler
    COMMAND ${CMAKE_CURRENT_BINARY_DIR}/test_temporal_other_compiler --gtest_brief=1)
endif()
