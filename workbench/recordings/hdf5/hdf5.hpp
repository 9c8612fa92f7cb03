// HDF5 files (.h5, .hdf5), read by a separate program, etlc-read-hdf5: libhdf5 is not safe on
// hostile files. Takes: a file and a group in it. Gives: the groups that match a pattern, and the
// group's datasets as a trace. Keeps true: a file that crashes the reader causes a failure here,
// with an E08 code; the reader's memory and time are limited, and links out of the file are not
// followed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "data/traces/trace.hpp"
#include "recordings/frames/frames.hpp"

namespace etlc::recordings {

/// Lists the groups whose path matches a pattern, "data/*", sorted bytewise: "data/demo_0", ...
diag::Result<std::vector<std::string>> list_hdf5(const std::string& path,
                                                 const std::string& pattern);

/// Opens the datasets that the channels name, relative to the group; an empty group is the root.
diag::Result<std::unique_ptr<data::Trace>> open_hdf5_trace(
    const std::string& path, const std::string& group, const std::vector<data::Channel>& channels);

/// Opens images, steps x rows x columns x 3 of uint8, or `with_grey` steps x rows x columns; an
/// empty name stands for the only dataset of images in colour in the group.
diag::Result<std::unique_ptr<FrameSource>> open_hdf5_images(const std::string& path,
                                                            const std::string& group,
                                                            const std::string& name,
                                                            bool with_grey);

}  // namespace etlc::recordings
