// Episodes of data sets.
// Takes: "pusht:3", or a path from --data. Gives: the columns of the rows as a trace, the frames of
// a camera, the list of episodes. Keeps true: rows, times and frames that differ from the metadata
// cause a failure; "action[3]" is an element of a column, for a scalar or a bool.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "data/traces/trace.hpp"
#include "recordings/datasets/dataset.hpp"
#include "recordings/frames/frames.hpp"

namespace etlc::recordings {

/// An episode that agrees with the metadata, and its data set.
struct SoundEpisode {
    std::shared_ptr<Dataset> set;
    const DatasetEpisode* episode = nullptr;
};
/// Failures: E0850, E0854.
diag::Result<SoundEpisode> find_episode(const std::string& path);

diag::Result<std::unique_ptr<data::Trace>> open_dataset_trace(
    const std::string& path, const std::vector<data::Channel>& channels);

/// Returns the number of rows in a step of 1 / rate seconds; 1 for a rate of 0. Failures: E0853.
diag::Result<std::uint64_t> rows_a_step(const Dataset& set, double rate);

/// Finds a camera by its name; an empty name stands for the only camera. Failures: E0852.
diag::Result<std::string> camera_of(const Dataset& set, const std::string& asked);

/// Says why a camera does not show the episode; empty: it does, according to the metadata.
std::string camera_lack(Dataset& set, const DatasetEpisode& episode, const std::string& camera);

/// Opens the frames of an episode, one for every `stride`-th row.
diag::Result<std::unique_ptr<FrameSource>> open_clip(Dataset& set, const DatasetEpisode& episode,
                                                     const std::string& camera,
                                                     std::uint64_t stride);

/// Returns the paths of the valid episodes of a data set; warns of the others (W0850).
diag::Result<std::vector<std::string>> find_dataset_episodes(const data::DatasetPath& path,
                                                             diag::Sink& sink);

/// Fails where the path is an episode of a data set whose rows are not at the rate of the spec.
/// 0 seconds, no rate, fits every data set.
std::optional<diag::Failure> check_rate(const std::string& path, double step_seconds);

}  // namespace etlc::recordings
