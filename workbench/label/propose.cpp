#include "label/propose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "calibrate/fit.hpp"
#include "data/text/text.hpp"
#include "episodes/leaks/leaks.hpp"
#include "episodes/ranking/auroc.hpp"
#include "episodes/recording.hpp"
#include "plan/plan.hpp"
#include "recordings/open.hpp"

namespace etlc::label {

namespace {

using Json = nlohmann::ordered_json;
using episodes::Label;
using Labels = std::vector<Label>;

/// Measurements of a predicate in an episode, one per step: smaller where it holds, NaN where a
/// sample is missing.
struct Measured {
    std::vector<float> scores;
    Labels labels;  ///< empty: nobody has labelled it
};

Labels labels_of(const std::vector<Interval>& intervals, std::uint64_t steps) {
    Labels labels(steps, Label::no);
    for (const Interval& one : intervals)
        std::fill(labels.begin() + static_cast<std::ptrdiff_t>(one.start),
                  labels.begin() + static_cast<std::ptrdiff_t>(one.end), one.label);
    return labels;
}

/// Measures all predicates of an episode. Failures do not name the path.
diag::Result<std::vector<Measured>> measure(const check::Model& model, const Desk& desk,
                                            std::size_t episode,
                                            const recordings::NamesInFile& names) {
    const Episode& of = desk.episodes()[episode];
    const std::vector<Index>& predicates = desk.predicates();
    std::vector<Index> recorded;
    for (std::size_t p = 0; p < predicates.size(); ++p)
        if (of.is_recorded[p]) recorded.push_back(predicates[p]);
    const plan::Plan plan = plan::measuring(model, predicates);
    const episodes::Leaks leaks(model, {});
    episodes::Follower follower(plan);
    auto recording = episodes::Recording::open(episodes::wanted(model, {&plan}, recorded, leaks),
                                               of.path, {names, nullptr});
    if (!recording) return recording.failure();
    std::vector<Measured> measured(predicates.size());
    const auto done = episodes::replay(*recording, {&follower}, [&] {
        for (std::size_t p = 0; p < predicates.size(); ++p) {
            const float delta = follower.evaluator().distance(predicates[p]);
            const bool is_upper = !model.predicates[predicates[p]].lower_bound();
            measured[p].scores.push_back(is_upper ? delta : -delta);
            if (of.is_recorded[p]) measured[p].labels.push_back(recording->label(predicates[p]));
        }
        return true;
    });
    if (!done) return done.failure();
    for (std::size_t p = 0; p < predicates.size(); ++p)
        if (const Marks& marks = desk.marks(episode, p); marks)
            measured[p].labels = labels_of(*marks, measured[p].scores.size());
    return measured;
}

/// Returns the runs of equal labels.
std::vector<Interval> runs_of(const Labels& labels) {
    std::vector<Interval> runs;
    for (std::size_t step = 0; step < labels.size(); ++step) {
        if (runs.empty() || runs.back().label != labels[step])
            runs.push_back({step, step, labels[step]});
        runs.back().end = step + 1;
    }
    return runs;
}

/// Returns the median of these delays; 0 where they are too few, or differ in their sign from one
/// quartile to the other, so that there is no habit to tell from chance.
std::int64_t usual_delay(std::vector<std::int64_t> delays) {
    if (delays.size() < kEnoughLabelled) return 0;
    std::sort(delays.begin(), delays.end());
    const std::int64_t low = delays[delays.size() / 4];
    const std::int64_t high = delays[delays.size() * 3 / 4];
    return low > 0 || high < 0 ? delays[delays.size() / 2] : 0;
}

/// Judges frames of a predicate by a threshold, and says which judgements are in doubt.
class Judge {
public:
    /// Learns from the labelled frames. `episodes`: what was measured of this predicate.
    static std::optional<Judge> learn(const check::Predicate& predicate,
                                      const std::vector<const Measured*>& episodes) {
        Judge judge(predicate);
        if (predicate.threshold.origin == check::ThresholdOrigin::literal)
            judge.epsilon_ =
                predicate.lower_bound() ? -predicate.threshold.value : predicate.threshold.value;
        else if (!judge.fit(episodes))
            return std::nullopt;
        judge.learn_doubt(episodes);
        judge.learn_runs(episodes);
        judge.learn_delays(episodes);
        return judge;
    }

    /// Returns the intervals of an episode, less the delays of the encoder.
    std::vector<Interval> intervals(const std::vector<float>& scores) const {
        std::vector<Interval> found = judged_intervals(scores);
        for (std::size_t k = 0; k < found.size(); ++k) {
            Interval& one = found[k];
            if (one.label != Label::yes) continue;
            const std::uint64_t from = k == 0 ? 0 : found[k - 1].end;
            const std::uint64_t to = k + 1 == found.size() ? scores.size() : found[k + 1].start;
            const std::uint64_t start = one.start == 0 ? 0 : earlier(one.start, starts_late_);
            const std::uint64_t end =
                one.end == scores.size() ? one.end : earlier(one.end, ends_late_);
            if (std::max(start, from) < std::min(end, to))
                one = {std::max(start, from), std::min(end, to), Label::yes};
        }
        return found;
    }

    /// Returns the share of the frames that are in doubt.
    double doubt(const std::vector<float>& scores) const {
        const auto count = std::count_if(scores.begin(), scores.end(), [&](float score) {
            return std::isnan(score) || margin(score) <= doubtful_;
        });
        return scores.empty() ? 0 : static_cast<double>(count) / static_cast<double>(scores.size());
    }

private:
    explicit Judge(const check::Predicate& predicate) : predicate_(&predicate) {}

    /// Returns the intervals by the frames alone. A run that is less than half as long as any
    /// labelled one takes the judgement before it, or after it at the beginning.
    std::vector<Interval> judged_intervals(const std::vector<float>& scores) const {
        Labels labels;
        for (const float score : scores) labels.push_back(judged(score));
        std::vector<Interval> kept;
        const auto is_short = [&](const Interval& run) {
            return 2 * (run.end - run.start) < shortest_run_;
        };
        for (const Interval& run : runs_of(labels)) {
            if (!kept.empty() && (is_short(run) || kept.back().label == run.label))
                kept.back().end = run.end;
            else if (kept.size() == 1 && is_short(kept.front()))
                kept.front() = {0, run.end, run.label};
            else
                kept.push_back(run);
        }
        std::erase_if(kept, [](const Interval& run) { return run.label == Label::no; });
        return kept;
    }

    Label judged(float score) const {
        if (std::isnan(score)) return Label::unknown;
        const bool is_equal = score == epsilon_;
        const bool holds = predicate_->comparison == check::Comparison::not_equal ? !is_equal
                           : predicate_->equality()                               ? is_equal
                           : predicate_->strict()                                 ? score < epsilon_
                                                  : score <= epsilon_;
        return holds ? Label::yes : Label::no;
    }

    double margin(float score) const {
        return std::abs(static_cast<double>(score) - static_cast<double>(epsilon_));
    }

    bool fit(const std::vector<const Measured*>& episodes) {
        episodes::FramesByScore frames;
        for_each_labelled(episodes, [&](float score, bool holds) {
            frames.add({score, 0, holds});
        });
        const auto found = calibrate::fit_f1(frames, predicate_->strict());
        if (!std::holds_alternative<calibrate::Fitted>(found)) return false;
        epsilon_ = std::get<calibrate::Fitted>(found).epsilon;
        return true;
    }

    /// Finds the margin within which nine of ten misjudged frames lie, or the least margin of all.
    void learn_doubt(const std::vector<const Measured*>& episodes) {
        std::vector<double> misjudged;
        double least = std::numeric_limits<double>::infinity();
        for_each_labelled(episodes, [&](float score, bool holds) {
            least = std::min(least, margin(score));
            if ((judged(score) == Label::yes) != holds) misjudged.push_back(margin(score));
        });
        doubtful_ = least;
        if (misjudged.empty()) return;
        const auto place =
            misjudged.begin() + static_cast<std::ptrdiff_t>(misjudged.size() * 9 / 10);
        std::nth_element(misjudged.begin(), place, misjudged.end());
        doubtful_ = *place;
    }

    void learn_runs(const std::vector<const Measured*>& episodes) {
        for (const Measured* one : episodes) {
            const std::vector<Interval> runs = runs_of(one->labels);
            for (const Interval& run : runs)
                if (runs.size() > 1) shortest_run_ = std::min(shortest_run_, run.end - run.start);
        }
        if (shortest_run_ == kNoRun) shortest_run_ = 0;
    }

    /// Finds how many steps after the labels the frames begin and cease to hold: an encoder sees a
    /// lamp that has just been lit, or a hand that has gone, some frames late.
    void learn_delays(const std::vector<const Measured*>& episodes) {
        std::vector<std::int64_t> starts, ends;
        for (const Measured* one : episodes) {
            if (one->labels.empty()) continue;
            const std::vector<Interval> judged = judged_intervals(one->scores);
            for (const Interval& labelled : runs_of(one->labels)) {
                if (labelled.label != Label::yes) continue;
                const auto overlap = [&](const Interval& of) {
                    return std::min(of.end, labelled.end) -
                           std::min({std::max(of.start, labelled.start), of.end, labelled.end});
                };
                const auto nearest = std::max_element(
                    judged.begin(), judged.end(),
                    [&](const auto& a, const auto& b) { return overlap(a) < overlap(b); });
                if (nearest == judged.end() || overlap(*nearest) == 0) continue;
                const auto after = [](std::uint64_t is, std::uint64_t should_be) {
                    return static_cast<std::int64_t>(is) - static_cast<std::int64_t>(should_be);
                };
                if (labelled.start > 0 && nearest->start > 0)
                    starts.push_back(after(nearest->start, labelled.start));
                if (labelled.end < one->labels.size() && nearest->end < one->labels.size())
                    ends.push_back(after(nearest->end, labelled.end));
            }
        }
        starts_late_ = usual_delay(std::move(starts));
        ends_late_ = usual_delay(std::move(ends));
    }

    static std::uint64_t earlier(std::uint64_t step, std::int64_t delay) {
        return static_cast<std::uint64_t>(
            std::max<std::int64_t>(static_cast<std::int64_t>(step) - delay, 0));
    }

    template <class Take>
    static void for_each_labelled(const std::vector<const Measured*>& episodes, const Take& take) {
        for (const Measured* one : episodes)
            for (std::size_t step = 0; step < one->labels.size(); ++step)
                if (one->labels[step] != Label::unknown && !std::isnan(one->scores[step]))
                    take(one->scores[step], one->labels[step] == Label::yes);
    }

    static constexpr std::uint64_t kNoRun = std::numeric_limits<std::uint64_t>::max();

    const check::Predicate* predicate_;
    float epsilon_ = 0;
    double doubtful_ = 0;  ///< margin
    std::uint64_t shortest_run_ = kNoRun;
    std::int64_t starts_late_ = 0;  ///< steps, by the frames alone
    std::int64_t ends_late_ = 0;
};

}  // namespace

std::vector<std::string> labelled_episodes(const Desk& desk) {
    std::vector<std::string> paths;
    for (std::size_t e = 0; e < desk.episodes().size(); ++e)
        if (desk.is_labelled(e)) paths.push_back(desk.episodes()[e].path);
    return paths;
}

std::optional<Proposals> propose(const check::Model& model, const Desk& desk,
                                 const recordings::NamesInFile& names, diag::Sink& sink) {
    std::vector<std::vector<Measured>> measured;
    for (std::size_t e = 0; e < desk.episodes().size(); ++e) {
        auto one = measure(model, desk, e, names);
        if (!one) {
            sink.report(recordings::in_trace(one.failure(), desk.episodes()[e].path));
            return std::nullopt;
        }
        measured.push_back(std::move(*one));
    }
    Proposals proposals;
    std::vector<std::optional<Judge>> judges;
    for (std::size_t p = 0; p < desk.predicates().size(); ++p) {
        std::vector<const Measured*> all;
        for (const auto& episode : measured) all.push_back(&episode[p]);
        judges.push_back(Judge::learn(model.predicates[desk.predicates()[p]], all));
        if (judges.back() || !proposals.why_none.empty()) continue;
        proposals.why_none = fmt::format(
            "no labelled step of {} is true, so there is nothing to learn its "
            "threshold from",
            data::in_quotes(desk.predicate(p)));
    }
    for (std::size_t e = 0; e < measured.size(); ++e) {
        Proposal proposal{e, 0, std::vector<Marks>(judges.size())};
        std::size_t count = 0;
        for (std::size_t p = 0; p < judges.size(); ++p) {
            if (!judges[p] || !measured[e][p].labels.empty()) continue;
            ++count;
            proposal.marks[p] = judges[p]->intervals(measured[e][p].scores);
            proposal.doubt += judges[p]->doubt(measured[e][p].scores);
        }
        if (count == 0) continue;
        proposal.doubt /= static_cast<double>(count);
        proposals.found.push_back(std::move(proposal));
    }
    std::stable_sort(proposals.found.begin(), proposals.found.end(),
                     [](const auto& a, const auto& b) { return a.doubt > b.doubt; });
    return proposals;
}

Json json_of(const Marks& marks) {
    if (!marks) return nullptr;
    Json intervals = Json::array();
    for (const Interval& one : *marks)
        intervals.push_back({one.start, one.end, one.label == Label::unknown ? 2 : 1});
    return intervals;
}

std::optional<Marks> marks_of(const Json& json, std::uint64_t steps) {
    if (json.is_null()) return Marks();
    std::vector<Interval> intervals;
    for (const Json& one : json) {
        const std::uint64_t from = intervals.empty() ? 0 : intervals.back().end;
        intervals.push_back({one.at(0), one.at(1), one.at(2) == 2 ? Label::unknown : Label::yes});
        const Interval& last = intervals.back();
        if (last.start < from || last.start >= last.end || last.end > steps) return std::nullopt;
    }
    return intervals;
}

std::string text_of(const Proposals& proposals, const Desk& desk) {
    Json all = Json::array();
    for (const Proposal& proposal : proposals.found) {
        Json marks = Json::object();
        for (std::size_t p = 0; p < proposal.marks.size(); ++p) {
            if (proposal.marks[p]) marks[desk.predicate(p)] = json_of(proposal.marks[p]);
        }
        all.push_back({{"episode", proposal.episode},
                       {"name", desk.episodes()[proposal.episode].name},
                       {"doubt", proposal.doubt},
                       {"predicates", marks}});
    }
    const Json text{{"labelled", labelled_episodes(desk).size()},
                    {"why_none", proposals.why_none},
                    {"proposals", all}};
    return text.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

Proposal proposal_of(const Json& text, const Desk& desk) {
    Proposal proposal{text.at("episode"), text.at("doubt"), {}};
    const std::uint64_t steps = desk.episodes().at(proposal.episode).steps;
    for (std::size_t p = 0; p < desk.predicates().size(); ++p)
        proposal.marks.push_back(
            marks_of(text.at("predicates").value(desk.predicate(p), Json()), steps)
                .value_or(Marks()));
    return proposal;
}

}  // namespace

std::optional<Proposals> parse_proposals(const std::string& text, const Desk& desk) {
    try {
        const auto all = Json::parse(text);
        Proposals proposals{all.at("why_none"), {}};
        for (const Json& one : all.at("proposals"))
            proposals.found.push_back(proposal_of(one, desk));
        return proposals;
    } catch (const std::exception&) {  // the program was another one, or was stopped
        return std::nullopt;
    }
}

}  // namespace etlc::label
