// Options of check.
#pragma once

#include <string>
#include <vector>

#include "artifacts/fitted.hpp"
#include "artifacts/thresholds.hpp"
#include "data/traces/trace.hpp"

namespace etlc::check {

/// --set NAME=VALUE: replaces the value of a constant.
struct Setting {
    std::string name;
    std::string number;  ///< decimal text, with a leading '-' if negative
    std::string unit;    ///< "us", "ms", "s", "min", "steps"; empty for a number
};

struct Options {
    /// Opens the recordings whose frames are rows of targets. The readers of most formats are in
    /// the workbench, so whoever compiles a spec that has some gives their function.
    data::OpenTrace open_trace = nullptr;
    /// Thresholds file; if empty, SPEC.thresholds.json beside the spec.
    std::string thresholds_path;
    /// Thresholds to use in place of a file.
    const thresholds::File* thresholds = nullptr;
    /// For `etlc calibrate`: no thresholds are read, and epsilon is NaN.
    bool allow_uncalibrated = false;
    /// For `etlc calibrate`: the shifts of monitors are not read, and are NaN.
    bool allow_uncalibrated_monitors = false;
    /// Fitted file; if empty, SPEC.fitted.npz beside the spec.
    std::string fitted_path;
    /// Fitted values to use in place of a file.
    const fitted::File* fitted = nullptr;
    /// File of embeddings; if empty, SPEC.embedded.npz beside the spec.
    std::string embedded_path;
    /// For `etlc fit`: fitted elements have their shape but no values.
    bool allow_unfitted = false;
    /// For `--check`: a missing target file, thresholds file or entry is a note, and what needs it
    /// is not checked.
    bool allow_missing = false;
    /// For `--lets`: the values of lets at each step are telemetry.
    bool lets = false;
    /// For `etlc evaluate`: so are those of lets with a truth.
    bool judged_lets = false;
    /// For `--retargetable`: the numbers of the spec may change while its monitors run.
    bool retargetable = false;
    std::vector<Setting> settings;
};

/// Returns SPEC.thresholds.json beside SPEC.etl.
std::string default_thresholds_path(const std::string& spec_path);

}  // namespace etlc::check
