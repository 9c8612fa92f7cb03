// Spec text to typed spec, for tests.
// Takes: the text. Gives: the model; a spec with errors fails the current test with its
// diagnostics.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "artifacts/thresholds.hpp"

namespace etlc::tests {

std::optional<check::Model> load(const std::string& text, const std::string& path = "test.etl");

/// The same with numbers that may change: --retargetable.
std::optional<check::Model> load_retargetable(const std::string& text);

/// The same where its thresholds file holds this JSON.
std::optional<check::Model> load_with_thresholds(const std::string& text,
                                                 const std::string& thresholds);

/// Makes the entry one that was calibrated from n equal scores of n episodes, the fewest that alpha
/// takes, so that it has this threshold. Takes its alpha; gives the episodes.
std::vector<std::uint64_t> calibrate_to(float epsilon, bool upper_bound, thresholds::Entry& entry);
/// Before there are thresholds: calibrated ones are NaN.
std::optional<check::Model> load_uncalibrated(const std::string& text);

/// The named cases, sorted: cases/NAME.etl with cases/NAME.csv, each of which once showed a fault.
std::vector<std::string> case_names();
/// Path of a case, without the ending.
std::string case_path(const std::string& name);

/// The bytes of a file; fails the current test where it cannot be read.
std::string read_text(const std::string& path);

}  // namespace etlc::tests
