// Decides which episodes a guarantee may rest on. Refuses those that void it: with a target among
// their frames, used twice, used by a fit or a calibration before, mostly equal to such an episode,
// or of its group. Every calibration asks here, so what is calibrated is exchangeable with future
// episodes as far as data can show; overlaps that the user allows are counted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/fitted.hpp"
#include "artifacts/thresholds.hpp"
#include "check/model/model.hpp"
#include "data/traces/overlap.hpp"
#include "diag/diag.hpp"
#include "episodes/ranking/auroc.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

// ---- recordings that share content --------------------------------------------------------------
// Finds episodes of a call that overlap each other, or episodes that something was made from. Finds
// what data::Recordings would find among all, and keeps in memory only the candidates
// (data/traces/overlap.hpp).

/// Episodes that something in a file was made from.
struct Source {
    data::KnownEpisodes contents;       ///< contents of these and of others
    std::vector<std::uint64_t> hashes;  ///< hashes of all of these
};

class OverlapSearch {
public:
    /// `each_other`: whether find_earlier will be called.
    OverlapSearch(const Identities& episodes, std::vector<Source> sources, bool each_other);

    /// Returns the overlap of `episode`, number `e` of the call, with source number `source`.
    std::optional<data::Overlap> find(std::size_t source, std::size_t e,
                                      const Recorded& episode) const;
    /// Returns the overlap with an earlier episode passed to this; `other` is its number in the
    /// call.
    std::optional<data::Overlap> find_earlier(std::size_t e, const Recorded& episode);

private:
    struct Seen {
        std::vector<std::uint64_t> hashes;  ///< sorted
        data::Recordings suspects;
    };
    std::vector<bool> is_suspect_;  ///< by number of the episode
    std::vector<Seen> seen_;        ///< by number of the source
    data::Recordings earlier_;
    std::vector<std::size_t> numbers_;  ///< numbers of these in the call
};

/// Counts of episodes that overlap an earlier one.
struct Overlaps {
    std::uint64_t repeated = 0;  ///< equal to an earlier one
    std::uint64_t overlapping = 0;
};
Overlaps overlaps(const Identities& episodes);

// ---- what is admitted ---------------------------------------------------------------------------

/// Decides whether rows of a target set were taken from frames of the episodes. A frame equal to a
/// row is a leak. A frame within rounding of a row is one if so many episodes would not have such
/// frames by chance, given how many lie near rows (episodes/leaks/leaks.hpp).
class LeakEvidence {
public:
    explicit LeakEvidence(const Identities& episodes);

    std::optional<Leak> of(const Recorded& episode) const;

private:
    std::vector<bool> leaks_;  ///< per watched set
};

/// Describes a leak: "step 4 is row 1 of target 'home', from which 'at_home' measures".
std::string text(const check::Model& model, const Leak& leak);

/// Admits episodes for calibration. `before` and `fitted`: the origin of thresholds and fits in the
/// model. `reason`: the argument of --allow-overlap; with it, targets among the frames and overlaps
/// short of equality are counted instead of refused.
thresholds::Allowance admit(const check::Model& model, const Identities& episodes,
                            const thresholds::File& before, const fitted::File& fitted,
                            const std::string& reason, diag::Sink& sink);

/// Admits episodes for evaluation: refuses those that thresholds were calibrated on or something
/// was fitted on, and counts overlaps with them if `reason` allows these.
thresholds::Allowance admit_unseen(const Identities& episodes, const thresholds::File& thresholds,
                                   const fitted::File& fitted, const std::string& reason,
                                   diag::Sink& sink);

/// Records the identities of the episodes in a file of thresholds or of fitted entries, and the
/// allowed overlaps, if any.
template <class File>
void record(const Identities& episodes, const thresholds::Allowance& allowance, File& file) {
    episodes.for_each([&](std::size_t, const Recorded& episode) {
        file.recordings.add(hash_of(episode), episode.content);
        if (!episode.group.empty()) file.groups[episode.hash] = episode.group;
    });
    if (allowance.overlapping + allowance.leaked > 0) file.allowances.push_back(allowance);
}

/// Remarks that --allow-overlap was not needed.
std::string remark_on(const thresholds::Allowance& allowance);

// ---- warnings about the data --------------------------------------------------------------------
// Warnings about episodes and their labels, shared by all commands that read these. Episodes that
// do not name the encoder of their embeddings cause one warning a call (W1001), and none without an
// encoder in the spec. Labels count as inverted only where the whole interval of the AUROC lies
// below 0.5.

void warn_of_unmarked(const Identities& episodes, diag::Sink& sink);
/// Reads the marks of the episodes. `inputs`: those that the command reads.
void warn_of_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                      const std::vector<std::string>& paths, const recordings::NamesInFile& names,
                      diag::Sink& sink);

/// The numbers of frames labelled true and false.
struct Labels {
    std::uint64_t positives = 0;
    std::uint64_t negatives = 0;
};

/// Warns of one-sided or inverted labels; returns whether it did.
bool warn_of_labels(const check::Predicate& predicate, Labels labels, const Figure& auroc,
                    diag::Sink& sink);

/// Reports a warning about the data that points into the spec.
diag::Diagnostic& warn_of_data(diag::Code code, std::string message, source::Span about,
                               diag::Sink& sink);

}  // namespace etlc::episodes
