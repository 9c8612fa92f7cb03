// What stands beside a recording: the other inputs, and labels.
// Takes: a .csv file with a column for each number and a row for each step; columns `truth.NAME`
// hold labels. Gives: an array for each name, which the episode gets too. Keeps true: an empty cell
// is a missing sample; the file is read like any trace, so what is wrong with it has an E08 code
// and a place.
#pragma once

#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "embed/recordings.hpp"

namespace etlc::embed {

/// Failures do not repeat the path. A column that is named like an input which an encoder makes is
/// one.
diag::Result<std::vector<Array>> arrays_beside(const check::Model& model, const std::string& path);

}  // namespace etlc::embed
