// What a call asks of check, besides the spec.
#pragma once

#include <string>
#include <vector>

#include "artifacts/fitted.hpp"
#include "artifacts/thresholds.hpp"

namespace etlc::check {

/// --set NAME=VALUE: another value for a constant.
struct Setting {
    std::string name;
    std::string number;  ///< decimal text, with a leading '-' where it is negative
    std::string unit;    ///< "us", "ms", "s", "min", "steps"; of a number ""
};

struct Options {
    /// Thresholds file; empty: SPEC.thresholds.json beside the spec where it exists.
    std::string thresholds_path;
    /// Thresholds that are in no file: then none is looked for.
    const thresholds::File* thresholds = nullptr;
    /// `etlc calibrate` reads a spec before it has thresholds: epsilon is then NaN and no file is
    /// looked for.
    bool allow_uncalibrated = false;
    /// Or before it has those of its monitors: their shift is then NaN.
    bool allow_uncalibrated_monitors = false;
    /// File of what is fitted; empty: SPEC.fitted.npz beside the spec where it exists.
    std::string fitted_path;
    /// What is fitted, and in no file: then none is looked for.
    const fitted::File* fitted = nullptr;
    /// File of embeddings; empty: SPEC.embedded.npz beside the spec.
    std::string embedded_path;
    /// `etlc fit` reads a spec before it has what it fits: that has its shape and no values.
    bool allow_unfitted = false;
    /// `--check` takes a spec before its files are there: a target file, a thresholds file or an
    /// entry of it that is missing is a note, and what builds on it is not checked.
    bool allow_missing = false;
    /// `--lets`: what lets say at each step is telemetry.
    bool lets = false;
    /// `--retargetable`: the numbers of the spec may change while its monitors run.
    bool retargetable = false;
    std::vector<Setting> settings;
};

/// Where the thresholds of a spec are looked for: SPEC.thresholds.json beside SPEC.etl.
std::string default_thresholds_path(const std::string& spec_path);

}  // namespace etlc::check
