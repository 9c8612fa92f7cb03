// What stands beside the frames of a recording: the other inputs, and labels.
// Takes: a .csv file with a column for each number and a row for each step, where columns
// `truth.NAME` hold labels; or the columns of a data set or of an archive of arrays. Gives: an
// array for each name, which the episode gets too. Keeps true: an empty cell is a missing sample;
// both are read like any trace, so what is wrong with it has an E08 code and a place.
#pragma once

#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "data/recordings/open.hpp"
#include "diag/diag.hpp"
#include "embed/recordings.hpp"

namespace etlc::embed {

/// Failures do not repeat the path. A column that is named like an input which an encoder makes is
/// one.
diag::Result<std::vector<Array>> arrays_beside(const check::Model& model, const std::string& path);

/// Of `recording.columns` the inputs of the model that no encoder makes, and the labels that
/// `names` has. Failures do not repeat the path.
diag::Result<std::vector<Array>> arrays_in(const check::Model& model, const Recording& recording,
                                           const data::NamesInFile& names);

}  // namespace etlc::embed
