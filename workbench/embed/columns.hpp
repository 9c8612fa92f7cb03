// What a recording has besides frames: the inputs that no encoder makes, and labels.
// Takes: a recording, and the table beside it. Gives: arrays with a row a step. Keeps true: a
// column with the name of an encoded input is a failure; failures do not repeat the path.
#pragma once

#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "embed/recordings.hpp"
#include "recordings/open.hpp"

namespace etlc::embed {

/// Reads the .csv file beside a recording: a column for each number, a row for each step, labels in
/// columns `truth.NAME`, empty cells for missing samples. Failures have E08 codes.
diag::Result<std::vector<Array>> arrays_beside(const check::Model& model, const std::string& path);

/// Reads the inputs that no encoder makes, and the labels that `names` has, from
/// `recording.columns`.
diag::Result<std::vector<Array>> arrays_in(const check::Model& model, const Recording& recording,
                                           const recordings::NamesInFile& names);

}  // namespace etlc::embed
