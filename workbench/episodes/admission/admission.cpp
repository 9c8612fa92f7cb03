#include "episodes/admission/admission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "artifacts/embedded.hpp"
#include "check/encoders/encoders.hpp"
#include "check/points/points.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "data/text/text.hpp"

namespace etlc::episodes {

// ---- recordings that share content --------------------------------------------------------------

OverlapSearch::OverlapSearch(const Identities& episodes, std::vector<Source> sources,
                             bool each_other) {
    bool compares = each_other;
    for (Source& source : sources) {
        std::sort(source.hashes.begin(), source.hashes.end());
        compares = compares || !source.contents.empty();
    }
    using Content = data::EpisodeContent;
    if (compares) {
        data::Suspects suspects(each_other);
        episodes.for_each([&](std::size_t, const Recorded& one) { suspects.ask(one.content); });
        for (const Source& source : sources)
            source.contents.for_each_of(
                source.hashes, [&](std::uint64_t, const Content& of) { suspects.know(of); });
        is_suspect_ = suspects.find();
    } else {
        is_suspect_.resize(episodes.size());
    }
    std::size_t next = episodes.size();
    for (Source& source : sources) {
        Seen& seen = seen_.emplace_back();
        source.contents.for_each_of(source.hashes, [&](std::uint64_t, const Content& content) {
            if (is_suspect_[next++]) seen.suspects.add(content);
        });
        seen.hashes = std::move(source.hashes);
    }
}

std::optional<data::Overlap> OverlapSearch::find(std::size_t source, std::size_t e,
                                                 const Recorded& episode) const {
    const Seen& seen = seen_[source];
    if (std::binary_search(seen.hashes.begin(), seen.hashes.end(), hash_of(episode)))
        return data::Overlap{0, 1, true};
    return is_suspect_[e] ? seen.suspects.find(episode.content) : std::nullopt;
}

std::optional<data::Overlap> OverlapSearch::find_earlier(std::size_t e, const Recorded& episode) {
    if (!is_suspect_[e]) return std::nullopt;
    auto found = earlier_.find(episode.content);
    if (found) found->other = numbers_[found->other];
    earlier_.add(episode.content);
    numbers_.push_back(e);
    return found;
}

Overlaps overlaps(const Identities& episodes) {
    OverlapSearch search(episodes, {}, true);
    Overlaps result;
    episodes.for_each([&](std::size_t e, const Recorded& episode) {
        const auto overlap = search.find_earlier(e, episode);
        result.repeated += overlap && overlap->equal ? 1 : 0;
        result.overlapping += overlap && !overlap->equal ? 1 : 0;
    });
    return result;
}

// ---- what is admitted ---------------------------------------------------------------------------

namespace {

/// Returns the probability of n or more of the frames by chance, with the mean chance for each.
/// That is an upper bound where n is above the expected number (Hoeffding, "On the Distribution of
/// the Number of Successes in Independent Trials", 1956).
double at_least(std::uint64_t n, const RoundedRows::Around& around) {
    const auto frames = static_cast<double>(around.frames);
    const auto count = static_cast<double>(n);
    const double chance = around.chance / frames;
    if (around.chance >= count) return 1;
    if (chance <= 0) return 0;
    double log = (frames - count) * std::log1p(-chance);
    for (double k = 1; k <= count; ++k) log += std::log((frames - count + k) / k * chance);
    double term = std::exp(log);
    double sum = 0;
    for (double k = count; k <= frames && term > sum * 1e-9; ++k) {
        sum += term;
        term *= (frames - k) / (k + 1) * chance / (1 - chance);
    }
    return sum;
}

/// The evidence of all episodes about one set.
struct Sum {
    std::uint64_t leaks = 0;  ///< episodes with a frame within rounding
    RoundedRows::Around close;
    RoundedRows::Around wide;
};

/// Tests that frames far around the rows are too few to put so many within rounding, and that
/// frames close to them do not merely crowd there.
bool is_no_chance(const Sum& sum) {
    constexpr double kNotByChance = 0.001;
    constexpr double kNotByCrowding = 0.3;
    return sum.leaks > 0 && at_least(sum.leaks, sum.wide) < kNotByChance &&
           at_least(sum.leaks, sum.close) < kNotByCrowding;
}

}  // namespace

LeakEvidence::LeakEvidence(const Identities& episodes) {
    std::vector<Sum> sums;
    episodes.for_each([&](std::size_t, const Recorded& episode) {
        if (episode.near.size() > sums.size()) sums.resize(episode.near.size());
        for (std::size_t i = 0; i < episode.near.size(); ++i) {
            sums[i].leaks += episode.near[i].first ? 1 : 0;
            sums[i].close.add(episode.near[i].close);
            sums[i].wide.add(episode.near[i].wide);
        }
    });
    for (const Sum& sum : sums) leaks_.push_back(is_no_chance(sum));
}

std::optional<Leak> LeakEvidence::of(const Recorded& episode) const {
    if (episode.leak) return episode.leak;
    for (std::size_t i = 0; i < episode.near.size(); ++i)
        if (leaks_[i] && episode.near[i].first) return episode.near[i].first;
    return std::nullopt;
}

namespace {

using diag::Code;

constexpr std::string_view kHowToAllow =
    "if they are different recordings after all, say why with --allow-overlap REASON: the reason "
    "is stored with the result and shown with every guarantee";

/// "shares about 97 % of its content with"
std::string in_common(const data::Overlap& overlap) {
    return fmt::format("shares about {:.0f} % of its content with", 100 * overlap.share);
}

/// Collects the episodes that are refused for one reason.
class Refusals {
public:
    Refusals(Code code, std::vector<std::string> notes) : code_(code), notes_(std::move(notes)) {}

    void add(const Recorded& episode, std::string message) {
        all_.push_back({episode.path, std::move(message)});
    }

    void report(diag::Sink& sink) const {
        constexpr std::size_t kMostReported = 10;
        const std::size_t reported = std::min(all_.size(), kMostReported);
        for (std::size_t i = 0; i < reported; ++i) {
            auto& error = sink.report(data::in_file({code_, all_[i].message}, all_[i].path));
            if (i > 0) continue;  // the notes hold for all
            for (const std::string& note : notes_) error.note(note);
            if (all_.size() > reported)
                error.note(fmt::format("{} episodes are refused for this; {} are shown",
                                       all_.size(), reported));
        }
    }

private:
    struct Refusal {
        std::string path;
        std::string message;
    };
    Code code_;
    std::vector<std::string> notes_;
    std::vector<Refusal> all_;
};

/// Refuses episodes that something in a file was made from.
class Unseen {
public:
    /// `source`: its index in the search; `groups`: of its episodes; `one`: what messages call such
    /// an episode; `advice`: the note for a repeated one; `allowing`: a further note for a partial
    /// overlap.
    Unseen(const OverlapSearch& search, std::size_t source, std::set<std::string> groups,
           bool allows, Code code, std::string one, const std::string& advice,
           std::string_view allowing)
        : search_(search),
          source_(source),
          groups_(std::move(groups)),
          allows_(allows),
          one_(std::move(one)),
          equal_(code, {advice}),
          in_part_(code, {advice, std::string(allowing)}) {}

    enum class Met : std::uint8_t { never, passed_over, refused };
    Met look_at(std::size_t e, const Recorded& episode) {
        const auto found = search_.find(source_, e, episode);
        if (!found && !groups_.contains(episode.group)) return Met::never;
        const bool is_equal = found && found->equal;
        if (allows_ && !is_equal) return Met::passed_over;
        if (is_equal)
            equal_.add(episode, "is " + one_);
        else if (found)
            in_part_.add(episode, in_common(*found) + " " + one_);
        else
            in_part_.add(episode, fmt::format("is of the group {}, as is {}",
                                              data::in_quotes(episode.group), one_));
        return Met::refused;
    }

    void report(diag::Sink& sink) const {
        equal_.report(sink);
        in_part_.report(sink);
    }

private:
    const OverlapSearch& search_;
    std::size_t source_;
    std::set<std::string> groups_;
    bool allows_;
    std::string one_;
    Refusals equal_;
    Refusals in_part_;
};

enum SourceNumber : std::size_t { fitted_file, thresholds_file };

/// Searches among the episodes of fits, then of calibration.
OverlapSearch search(const Identities& episodes, const fitted::File& fitted,
                     const thresholds::File& thresholds, std::vector<std::uint64_t> calibrated_on,
                     bool each_other) {
    return {
        episodes,
        {{fitted.recordings, fitted.episodes}, {thresholds.recordings, std::move(calibrated_on)}},
        each_other};
}

/// Returns the groups of these episodes.
std::set<std::string> groups_among(const thresholds::GroupNames& names,
                                   const std::vector<std::uint64_t>& episodes) {
    std::set<std::string> result;
    for (const std::uint64_t episode : episodes)
        if (const auto found = names.find(data::hash_text(episode)); found != names.end())
            result.insert(found->second);
    return result;
}

/// Refuses episodes that something was fitted on.
Unseen not_fitted_on(const OverlapSearch& search, const fitted::File& file, bool allows,
                     std::string_view allowing) {
    return {search,
            fitted_file,
            groups_among(file.groups, file.episodes),
            allows,
            Code::episode_fitted_on,
            fmt::format("an episode that the projections, targets or metrics in {} were fitted on",
                        file.path),
            "keep the episodes for fitting apart from those for calibration and evaluation: what "
            "is fitted separates them better than any others",
            allowing};
}

/// Examines the episodes in order.
class Admission {
public:
    Admission(const check::Model& model, const Identities& episodes, const thresholds::File& before,
              const fitted::File& fitted, const std::string& reason)
        : model_(model),
          episodes_(episodes),
          allows_(!reason.empty()),
          leak_evidence_(episodes),
          search_(search(episodes, fitted, before, before.episodes, true)),
          not_fitted_on_(not_fitted_on(search_, fitted, allows_, kHowToAllow)),
          unseen_(search_, thresholds_file, groups_among(before.groups, before.episodes), allows_,
                  Code::not_disjoint, "an episode that thresholds of predicates were calibrated on",
                  "calibrate monitors on other episodes: thresholds look too good on those that "
                  "they were calibrated on",
                  kHowToAllow) {
        passed_over_.reason = reason;
    }

    void look_at(std::size_t e, const Recorded& episode) {
        const Unseen::Met fitted_on = not_fitted_on_.look_at(e, episode);
        if (fitted_on == Unseen::Met::refused) return;  // the fit was made from its frames
        const Unseen::Met calibrated_on = unseen_.look_at(e, episode);
        const bool overlaps =
            fitted_on == Unseen::Met::passed_over || calibrated_on == Unseen::Met::passed_over;
        passed_over_.overlapping += look_at_earlier(e, episode) || overlaps ? 1 : 0;
        const auto leak = leak_evidence_.of(episode);
        if (leak && allows_) ++passed_over_.leaked;
        if (leak && !allows_)
            (of_scalars(*leak) ? scalar_leaks_ : leaks_).add(episode, text(model_, *leak));
    }

    thresholds::Allowance conclude(diag::Sink& sink) && {
        not_fitted_on_.report(sink);
        unseen_.report(sink);
        for (const Refusals* refusals : {&repeated_, &overlapping_, &leaks_, &scalar_leaks_})
            refusals->report(sink);
        return std::move(passed_over_);
    }

private:
    /// Returns whether an overlap was allowed.
    bool look_at_earlier(std::size_t e, const Recorded& episode) {
        const auto found = search_.find_earlier(e, episode);
        if (!found) return false;
        const std::string other = data::in_quotes(episodes_[found->other].path);
        if (found->equal)
            repeated_.add(episode, "is the same episode as " + other);
        else if (!allows_)
            overlapping_.add(episode, in_common(*found) + " " + other);
        return allows_ && !found->equal;
    }

    bool of_scalars(const Leak& leak) const {
        return !model_.inputs[model_.point_of(leak.distance).inputs[0]].is_embedding();
    }

    const check::Model& model_;
    const Identities& episodes_;
    bool allows_;
    LeakEvidence leak_evidence_;
    OverlapSearch search_;
    Unseen not_fitted_on_;
    Unseen unseen_;
    thresholds::Allowance passed_over_;
    Refusals repeated_{
        Code::duplicate_episode,
        {"demonstrations have to be independent recordings: one that counts twice voids the "
         "guarantee"}};
    Refusals overlapping_{
        Code::overlapping_episodes,
        {"demonstrations have to be independent recordings: parts of one count twice",
         std::string(kHowToAllow)}};
    Refusals leaks_{
        Code::target_in_data,
        {"targets have to come from other recordings: at a distance of 0 this one voids the "
         "guarantee",
         std::string(kHowToAllow)}};
    Refusals scalar_leaks_{
        Code::target_in_data,
        {"targets have to come from other recordings: at a distance of 0 this one voids the "
         "guarantee",
         "if these scalars can have such values by themselves, write the rows into the spec: only "
         "rows from a file count as recorded"}};
};

}  // namespace

std::string text(const check::Model& model, const Leak& leak) {
    const bool is_row =
        check::as_of_now(model, model.distances[leak.distance].point) != check::kNone;
    return fmt::format("step {} is {}row {} of target '{}', from which '{}' measures", leak.frame,
                       is_row ? "" : "a part of ", leak.row,
                       model.targets[model.distances[leak.distance].target].name,
                       model.predicates[leak.predicate].shown());
}

thresholds::Allowance admit(const check::Model& model, const Identities& episodes,
                            const thresholds::File& before, const fitted::File& fitted,
                            const std::string& reason, diag::Sink& sink) {
    Admission admission(model, episodes, before, fitted, reason);
    episodes.for_each(
        [&](std::size_t e, const Recorded& episode) { admission.look_at(e, episode); });
    return std::move(admission).conclude(sink);
}

thresholds::Allowance admit_unseen(const Identities& episodes, const thresholds::File& thresholds,
                                   const fitted::File& fitted, const std::string& reason,
                                   diag::Sink& sink) {
    constexpr std::string_view kAllowing =
        "if they are different recordings after all, say why with --allow-overlap REASON: the "
        "reason is shown with the figures";
    thresholds::Allowance passed_over{reason};
    const OverlapSearch among =
        search(episodes, fitted, thresholds, thresholds::all_episodes(thresholds), false);
    Unseen not_fitted = not_fitted_on(among, fitted, !reason.empty(), kAllowing);
    Unseen unseen(
        among, thresholds_file,
        groups_among(thresholds.groups, thresholds::all_episodes(thresholds)), !reason.empty(),
        Code::episode_calibrated_on,
        fmt::format("an episode that the thresholds in {} were calibrated on", thresholds.path),
        "keep the episodes for evaluation apart from those for calibration", kAllowing);
    episodes.for_each([&](std::size_t e, const Recorded& episode) {
        const Unseen::Met fitted_on = not_fitted.look_at(e, episode);
        const Unseen::Met calibrated_on = unseen.look_at(e, episode);
        const bool overlaps =
            fitted_on == Unseen::Met::passed_over || calibrated_on == Unseen::Met::passed_over;
        passed_over.overlapping += overlaps ? 1 : 0;
    });
    not_fitted.report(sink);
    unseen.report(sink);
    return passed_over;
}

std::string remark_on(const thresholds::Allowance& allowance) {
    const bool idle = !allowance.reason.empty() && allowance.overlapping + allowance.leaked == 0;
    return idle ? "\n--allow-overlap was not needed: nothing overlaps\n" : "";
}

// ---- warnings about the data --------------------------------------------------------------------

namespace {

/// Counts the unmarked episodes of a call.
class Unmarked {
public:
    void add(const std::string& path, bool is_unmarked) {
        ++episodes_;
        if (!is_unmarked) return;
        if (++count_ == 1) first_ = path;
    }

    void report(diag::Sink& sink) const {
        if (count_ == 0) return;
        diag::Diagnostic& warning = sink.report(recordings::in_trace(
            {diag::Code::unmarked_episode, "does not say which encoder made its embeddings"},
            first_));
        if (episodes_ > 1)
            warning.note(fmt::format("this applies to {} of {} episodes", count_, episodes_));
        check::explain_unmarked(warning);
    }

private:
    std::string first_;
    std::size_t count_ = 0;
    std::size_t episodes_ = 0;
};

}  // namespace

void warn_of_unmarked(const Identities& episodes, diag::Sink& sink) {
    Unmarked unmarked;
    episodes.for_each([&](std::size_t, const Recorded& episode) {
        unmarked.add(episode.path, episode.is_unmarked);
    });
    unmarked.report(sink);
}

void warn_of_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                      const std::vector<std::string>& paths, const recordings::NamesInFile& names,
                      diag::Sink& sink) {
    if (model.encoders.empty()) return;
    Unmarked unmarked;
    for (const std::string& path : paths) {
        const auto marks = embedded::read_marks(path);
        unmarked.add(path, marks && is_unmarked(model, inputs, names, *marks));
    }
    unmarked.report(sink);
}

diag::Diagnostic& warn_of_data(diag::Code code, std::string message, source::Span about,
                               diag::Sink& sink) {
    diag::Diagnostic found = data::in_file({code, std::move(message)}, "--data");
    found.span = about;
    return sink.report(std::move(found));
}

bool warn_of_labels(const check::Predicate& predicate, Labels labels, const Figure& auroc,
                    diag::Sink& sink) {
    const std::uint64_t all = labels.positives + labels.negatives;
    const source::Span span = predicate.threshold.span;
    if (all > 0 && (labels.positives == 0 || labels.negatives == 0)) {
        const bool holds = labels.negatives == 0;
        warn_of_data(diag::Code::one_sided_labels,
                     fmt::format("'{}' is {} at all {}", predicate.name, holds ? "true" : "false",
                                 diag::counted(all, "labelled frame")),
                     span, sink)
            .note(fmt::format("there are no labels of frames at which it is {}: look at its truth "
                              "or its labels truth.{}, or record such frames too",
                              holds ? "false" : "true", predicate.name));
        return true;
    }
    if (!auroc.interval || auroc.interval->high >= 0.5) return false;
    warn_of_data(
        diag::Code::inverted_labels,
        fmt::format("the labels of '{}' are the wrong way round for what it measures: the "
                    "area under the ROC curve is {:.2f}, with a 95 % interval from {:.2f} "
                    "to {:.2f}",
                    predicate.name, *auroc.value, auroc.interval->low, auroc.interval->high),
        span, sink)
        .note(
            fmt::format("below 0.5, {} numbers are labelled true: look at its truth or its labels "
                        "truth.{}, and at the comparison",
                        predicate.upper_bound() ? "the greater" : "the smaller", predicate.name));
    return true;
}

}  // namespace etlc::episodes
