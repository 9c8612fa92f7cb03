# Files of targets, and the search in them.
etlc_test(test_targets SOURCES test_search.cpp test_targets.cpp LIBRARIES etlmon::etlmon)
