// The episodes of a call, read once.
// Takes: the episodes, and what is wanted of each. Gives: them in the order of their content, and
// each to be gone through again. Keeps true: neither names of files nor the order of arguments
// count; what fits into `most_kept` bytes, all episodes together, is not read again.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "check/guarantees/provenance.hpp"
#include "diag/diag.hpp"
#include "episodes/recording.hpp"
#include "fit/kept.hpp"
#include "fit/request.hpp"

namespace etlc::fit {

class Readings {
public:
    /// Nothing where the sink now says why.
    static std::optional<Readings> read(episodes::Wanted wanted, const Request& request,
                                        diag::Sink& sink);

    /// By content, as episodes/folds.hpp orders them.
    const std::vector<episodes::Recorded>& episodes() const { return episodes_; }
    /// Of the same.
    std::vector<std::string> paths() const;
    const check::Labelling& labelling() const { return labelling_; }
    std::size_t index_of(const std::string& path) const { return index_.at(path); }
    const episodes::Wanted& wanted() const { return *wanted_; }

    /// From its first frame. Any number of threads may use it at once. Failures do not name the
    /// episode.
    diag::Result<std::unique_ptr<episodes::Frames>> open(std::size_t episode) const;

private:
    std::unique_ptr<const episodes::Wanted> wanted_;
    data::NamesInFile names_;
    std::vector<episodes::Recorded> episodes_;
    std::vector<std::shared_ptr<const Kept>> kept_;  ///< per episode; null: to be read again
    std::unordered_map<std::string, std::size_t> index_;
    check::Labelling labelling_;
};

}  // namespace etlc::fit
