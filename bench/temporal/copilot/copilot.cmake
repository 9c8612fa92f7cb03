# Copilot's monitors, if GHC and libghc-copilot-dev are installed. Its C files define functions with
# the same names, so only the step of each object stays visible.
find_program(ETLC_RUNGHC runghc)
mark_as_advanced(ETLC_RUNGHC)
set(has_copilot FALSE)
if(ETLC_RUNGHC AND CMAKE_OBJCOPY)
  execute_process(COMMAND ghc-pkg list --simple-output copilot-c99
    OUTPUT_VARIABLE copilot_c99 ERROR_QUIET)
  if(copilot_c99)
    set(has_copilot TRUE)
  endif()
endif()
if(NOT has_copilot)
  message(STATUS "bench_temporal: no Copilot (libghc-copilot-dev), its column stays empty")
  return()
endif()

set(folder ${CMAKE_CURRENT_BINARY_DIR}/copilot)
file(MAKE_DIRECTORY ${folder})
set(names invariant eventually_50 sequence response_50)
set(sources)
foreach(name IN LISTS names)
  list(APPEND sources ${folder}/copilot_${name}.c)
endforeach()
add_custom_command(OUTPUT ${sources}
  COMMAND ${ETLC_RUNGHC} ${CMAKE_CURRENT_SOURCE_DIR}/copilot/Monitors.hs ${folder}
  DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/copilot/Monitors.hs
  COMMENT "Writing Copilot's monitors" VERBATIM)
foreach(name IN LISTS names)
  set(object ${folder}/copilot_${name}.o)
  add_custom_command(OUTPUT ${object}
    COMMAND ${CMAKE_CXX_COMPILER} -x c -O2 -w -c ${folder}/copilot_${name}.c -o ${object}
    COMMAND ${CMAKE_OBJCOPY} --keep-global-symbol=copilot_${name}_step ${object}
    DEPENDS ${folder}/copilot_${name}.c COMMENT "Compiling copilot_${name}.c" VERBATIM)
  target_sources(bench_temporal PRIVATE ${object})
  set_source_files_properties(${object} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
endforeach()
set_source_files_properties(copilot/copilot.cpp PROPERTIES COMPILE_DEFINITIONS ETLC_HAS_COPILOT)
