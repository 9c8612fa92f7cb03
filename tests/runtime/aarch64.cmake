# The tests of the kernels on AArch64 with NEON: cross-compiled, run by qemu-user. They are static,
# so they need no foreign libraries.
find_program(ETLC_AARCH64 aarch64-linux-gnu-g++)
find_program(ETLC_QEMU_AARCH64 qemu-aarch64)
find_path(ETLC_GTEST_SOURCES src/gtest-all.cc PATHS /usr/src/googletest/googletest)
mark_as_advanced(ETLC_AARCH64 ETLC_QEMU_AARCH64 ETLC_GTEST_SOURCES)
if(NOT ETLC_AARCH64 OR NOT ETLC_QEMU_AARCH64 OR NOT ETLC_GTEST_SOURCES)
  etlc_missing_tool(aarch64-linux-gnu-g++ "g++-aarch64-linux-gnu, qemu-user and googletest")
  return()
endif()

set(objects)
# etlc_aarch64_object(SOURCE option...): one object of the program.
function(etlc_aarch64_object source)
  get_filename_component(name ${source} NAME)
  add_custom_command(OUTPUT aarch64_${name}.o
    COMMAND ${CMAKE_CXX_COMPILER_LAUNCHER} ${ETLC_AARCH64} -std=c++17 -O2
            -isystem ${ETLC_GTEST_SOURCES}/include ${ARGN} -c ${source} -o aarch64_${name}.o
    DEPENDS ${source} ${kernel_files} VERBATIM)
  set(objects ${objects} aarch64_${name}.o PARENT_SCOPE)
endfunction()
etlc_aarch64_object(${ETLC_GTEST_SOURCES}/src/gtest-all.cc -I${ETLC_GTEST_SOURCES} -w -O0)
etlc_aarch64_object(${ETLC_GTEST_SOURCES}/src/gtest_main.cc -I${ETLC_GTEST_SOURCES} -w)
get_target_property(eigen_headers Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
foreach(source ${here}/exact.cpp ${kernel_sources} ${twins} ${narrow_sources})
  etlc_aarch64_object(${source}
    -I${PROJECT_SOURCE_DIR}/runtime/include -isystem ${eigen_headers} ${kernel_warnings})
endforeach()
add_custom_command(OUTPUT test_kernels_aarch64
  # ld warns that gtest's getaddrinfo would need the C library at run time; no test calls it.
  COMMAND ${ETLC_AARCH64} -static -Wl,--no-warnings ${objects} -o test_kernels_aarch64
  DEPENDS ${objects} VERBATIM)
add_custom_target(kernels_aarch64 ALL DEPENDS test_kernels_aarch64)
add_test(NAME test_kernels_aarch64
  COMMAND ${ETLC_QEMU_AARCH64} ${CMAKE_CURRENT_BINARY_DIR}/test_kernels_aarch64 --gtest_brief=1)
set_tests_properties(test_kernels_aarch64 PROPERTIES COST 90)
