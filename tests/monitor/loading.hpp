// Turns spec text into a typed spec, for tests.
// Takes: the text. Gives: the model; a spec with errors fails the current test with its
// diagnostics.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "check/model/model.hpp"

namespace etlc::tests {

std::optional<check::Model> load(const std::string& text, const std::string& path = "test.etl");

/// The same with --retargetable.
std::optional<check::Model> load_retargetable(const std::string& text);

/// The same with this JSON as its thresholds file.
std::optional<check::Model> load_with_thresholds(const std::string& text,
                                                 const std::string& thresholds);

/// Makes the entry one that was calibrated from n equal scores of n episodes, the fewest that alpha
/// allows, so that it has this threshold, which is above its scores or below, and `inner`, which is
/// on the other side. Takes its alpha; returns the episodes.
std::vector<std::uint64_t> calibrate_to(float epsilon, bool above, thresholds::Entry& entry,
                                        std::optional<float> inner = {});

/// A spec whose predicates are calibrated, and its thresholds file.
struct CalibratedSpec {
    std::string text;
    std::vector<float> literals;  ///< thresholds that were replaced, in the order of the predicates
    std::string thresholds;
    std::optional<check::Model> model;
};
/// Replaces most thresholds of the named predicates of a random spec by two; some of these are
/// equal, infinite, or in the wrong order, so that the demonstrations are separated.
CalibratedSpec with_two_thresholds(const std::string& spec, std::uint64_t seed);
/// Without thresholds: calibrated ones are NaN.
std::optional<check::Model> load_uncalibrated(const std::string& text);

/// The named cases, sorted: cases/NAME.etl with cases/NAME.csv, each of which once revealed a bug.
std::vector<std::string> case_names();
/// Returns the path of a case, without the extension.
std::string case_path(const std::string& name);

/// Returns the bytes of a file; fails the current test if it cannot be read.
std::string read_text(const std::string& path);

}  // namespace etlc::tests
