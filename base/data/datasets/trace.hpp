// Episodes of data sets.
// Takes: "pusht:3", or what --data names. Gives: the columns of the rows as a trace, the frames of
// a camera, the episodes that there are. Keeps true: rows, times and frames are what the metadata
// say, or it is a failure; "action[3]" is an element of a column, for a scalar or a bool.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "data/datasets/dataset.hpp"
#include "data/frames/frames.hpp"
#include "data/traces/trace.hpp"

namespace etlc::data {

/// An episode that is as the metadata say, and its data set. Failures: E0850, E0854.
struct SoundEpisode {
    std::shared_ptr<Dataset> set;
    const DatasetEpisode* episode = nullptr;
};
diag::Result<SoundEpisode> find_episode(const std::string& path);

diag::Result<std::unique_ptr<Trace>> open_dataset_trace(const std::string& path,
                                                        const std::vector<Channel>& channels);

/// How many rows a step of 1 / rate seconds takes; a rate of 0: every row is a step. Failures:
/// E0853.
diag::Result<std::uint64_t> rows_a_step(const Dataset& set, double rate);

/// The camera that is asked for; empty: the only one. Failures: E0852.
diag::Result<std::string> camera_of(const Dataset& set, const std::string& asked);

/// Why a camera does not show the episode; empty: it does, as far as the metadata tell.
std::string camera_lack(Dataset& set, const DatasetEpisode& episode, const std::string& camera);

/// A frame a step: of every `stride`-th row, `steps` of them.
diag::Result<std::unique_ptr<FrameSource>> open_clip(Dataset& set, const DatasetEpisode& episode,
                                                     const std::string& camera,
                                                     std::uint64_t stride);

/// The sound episodes of a data set, as paths; what it lacks is a warning (W0850).
diag::Result<std::vector<std::string>> find_dataset_episodes(const DatasetPath& path,
                                                             diag::Sink& sink);

/// Where the steps of a spec and the rows of an episode, if it is one of a data set, do not come at
/// one rate; a rate of 0 fits every one.
std::optional<diag::Failure> check_rate(const std::string& path, double step_seconds);

}  // namespace etlc::data
