// Recordings that hold more than frames: episodes of data sets, archives of arrays.
// Takes: a path of one and what is looked for. Gives: its recordings. Keeps true: a camera is named
// where there are several; what an episode of a data set lacks is a warning that names it.
#pragma once

#include <string>
#include <vector>

#include "data/datasets/dataset.hpp"
#include "embed/recordings.hpp"

namespace etlc::embed {

diag::Result<std::vector<Recording>> recordings_in_dataset(const data::DatasetPath& path,
                                                           const Search& search, diag::Sink& sink);

/// Whether the path is that of arrays: .npz, .h5, .hdf5 or FILE.h5:GROUP.
bool is_arrays(const std::string& path);
diag::Result<std::vector<Recording>> recordings_in_arrays(const std::string& path,
                                                          const Search& search);

}  // namespace etlc::embed
