// Syntax tree to typed spec.
// Takes: the tree, and the files it loads (paths relative to the spec). Gives: the model, or
// nothing where there was an error. Keeps true: all errors are reported in one go, each cause once;
// a broken declaration hides no other and causes no cascade.
#pragma once

#include <optional>
#include <string>

#include "ast/ast.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"

namespace etlc::check {

struct Options {
    /// Thresholds file; empty: SPEC.thresholds.json beside the spec where it exists.
    std::string thresholds_path;
    /// `etlc calibrate` reads a spec before it has thresholds: epsilon is then NaN and no file is
    /// looked for.
    bool allow_uncalibrated = false;
    /// Or before it has those of its monitors: their shift is then NaN.
    bool allow_uncalibrated_monitors = false;
};

/// Where the thresholds of a spec are looked for: SPEC.thresholds.json beside SPEC.etl.
std::string default_thresholds_path(const std::string& spec_path);

std::optional<Model> check(const ast::Spec& spec, const source::File& file, const Options& options,
                           diag::Sink& sink);

}  // namespace etlc::check
