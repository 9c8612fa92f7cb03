# Files of targets, and the search in them.
etlc_test(test_targets RUNTIME SOURCES test_search.cpp test_targets.cpp LIBRARIES etlmon::etlmon)
target_compile_options(test_targets PRIVATE -O2)
