// Reads the episodes of a call once, in the order of their content, and gives their frames again
// for later passes. Neither names of files nor the order of arguments count.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "check/guarantees/provenance.hpp"
#include "diag/diag.hpp"
#include "episodes/recording.hpp"
#include "recordings/open.hpp"

namespace etlc::fit {

/// The arguments of `etlc fit`.
struct Request {
    std::vector<std::string> episodes;  ///< as recordings::find_episodes gives them
    episodes::ReadOptions reading;
    /// The reason of --allow-overlap; empty without the option.
    std::string allow_overlap;
    unsigned jobs = 0;  ///< threads; 0: as many as the machine has
    /// Whether to measure how well predicates separate frames that were not fitted on, which takes
    /// another fit without each fold.
    bool separation = true;
    std::string version;  ///< version of etlc
    /// Called by any thread, one at a time.
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// The most bytes of samples to keep in memory, unless `reading` keeps them.
    std::size_t most_kept = episodes::kMostKept;
};

using check::Index;

class Readings {
public:
    /// Leaves out episodes without a label that is wanted, unless all are. Returns nothing after an
    /// error.
    static std::optional<Readings> read(episodes::Wanted wanted, const Request& request,
                                        diag::Sink& sink);

    /// Returns the episodes in the order of episodes/folds.hpp.
    const std::vector<episodes::Recorded>& episodes() const { return episodes_; }
    /// Returns their paths.
    std::vector<std::string> paths() const;
    /// Returns the paths of those that were left out.
    const std::vector<std::string>& unlabelled() const { return unlabelled_; }
    const check::Labelling& labelling() const { return labelling_; }
    std::size_t index_of(const std::string& path) const { return index_.at(path); }
    const episodes::Wanted& wanted() const { return *wanted_; }

    /// Opens an episode at its first frame. Thread-safe. Failures do not name the episode.
    diag::Result<episodes::Recording> open(std::size_t episode) const;

private:
    std::unique_ptr<const episodes::Wanted> wanted_;
    episodes::ReadOptions reading_;
    std::vector<episodes::Recorded> episodes_;
    std::vector<std::string> unlabelled_;
    std::unordered_map<std::string, std::size_t> index_;
    check::Labelling labelling_;
};

}  // namespace etlc::fit
