// Images of a camera that lie in the rows of a data set, a struct of bytes and path in each.
// Takes: an episode, a camera and a stride. Gives: a frame of every stride-th row. Keeps true:
// memory is that of one row and one frame; a row without its image is a failure that names it.
#pragma once

#include <memory>
#include <string>

#include "data/datasets/dataset.hpp"
#include "data/frames/frames.hpp"

namespace etlc::data {

/// Failures name the file of the rows: E0851; E1009 of an image, with its row in the episode.
diag::Result<std::unique_ptr<FrameSource>> open_stored_images(const Dataset& set,
                                                              const DatasetEpisode& episode,
                                                              const std::string& camera,
                                                              std::uint64_t stride);

}  // namespace etlc::data
