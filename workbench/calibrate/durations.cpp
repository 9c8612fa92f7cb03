#include "calibrate/durations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/replayer.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/guarantees/guarantees.hpp"
#include "check/guarantees/provenance.hpp"
#include "execute/evaluator.hpp"

namespace etlc::calibrate {

namespace {

using diag::Code;
using diag::counted;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostPlans = 256;

/// Returns the model with this monitor alone, in which an input stands for each of its predicates.
check::Model alone(const check::Model& model, Index monitor, const std::vector<Index>& predicates) {
    check::Model result = model;
    result.truths.clear();
    result.lets.clear();
    result.monitors = {model.monitors[monitor]};
    result.monitors[0].truth = check::kNone;
    measure_by_inputs(result, predicates);
    // Nothing is measured, so each of the plans below copies less.
    for (check::Target& target : result.targets) target.values.clear();
    for (check::Projection& projection : result.projections) projection.matrix.clear();
    for (check::Distance& distance : result.distances) distance.weights.clear();
    return result;
}

/// Returns a number between two others, which most calls with neighbouring numbers return too.
std::uint32_t between(std::uint32_t low, std::uint32_t high) {
    std::uint32_t found = high - 1;
    while ((found & (found - 1)) > low) found &= found - 1;
    return found;
}

/// Robustness 0 counts as satisfied, but a Boolean class decides by the comparison.
Ends decided(const check::Predicate& predicate, Ends value) {
    if (value.high == 0 && predicate.strict()) value.high = -1;
    if (value.low == 0 && !predicate.strict()) value.low = 1;
    return value;
}

}  // namespace

std::vector<Index> timed_monitors(const check::Model& model) {
    std::vector<Index> found;
    for (Index m = 0; m < model.monitors.size(); ++m)
        if (model.monitors[m].duration) found.push_back(m);
    return found;
}

// ---- the score of an episode --------------------------------------------------------------------

DurationScorer::DurationScorer(const check::Model& model, Index monitor)
    : duration_(*model.monitors[monitor].duration),
      predicates_(check::predicates_of(model, model.monitors[monitor].formula)),
      flags_(check::flags_of(model, model.monitors[monitor].formula)) {
    model_ = alone(model, monitor, predicates_);
}

void DurationScorer::reset() {
    values_.clear();
    bools_.clear();
    steps_ = 0;
}

void DurationScorer::add(const std::vector<std::optional<Ends>>& values,
                         const episodes::Frames& frames) {
    for (const Index p : predicates_) {
        std::optional<Ends> value = values[p];
        if (value) value = decided(model_.predicates[p], *value);
        values_.push_back(value);
    }
    for (const Index f : flags_) {
        const execute::Sample& sample = frames.samples()[f];
        const bool is_there = sample.present && !sample.values.empty();
        bools_.push_back(is_there ? std::optional(sample.values[0] != 0) : std::nullopt);
    }
    ++steps_;
}

diag::Result<double> DurationScorer::score() {
    // A duration as long as the episode reaches beyond it from everywhere, as any longer one does.
    std::uint32_t saved = std::min(duration_.greatest, std::max(duration_.least, steps_));
    std::uint32_t violated = duration_.least;
    if (!duration_.longer_is_truer) std::swap(saved, violated);
    const auto worst = is_violated(violated);
    if (!worst) return worst.failure();
    if (!*worst)
        return duration_.longer_is_truer ? static_cast<double>(duration_.least) : -kInfinity;
    const auto best = is_violated(saved);
    if (!best) return best.failure();
    if (*best) return kInfinity;
    while (std::max(saved, violated) - std::min(saved, violated) > 1) {
        const std::uint32_t middle = between(std::min(saved, violated), std::max(saved, violated));
        const auto found = is_violated(middle);
        if (!found) return found.failure();
        (*found ? violated : saved) = middle;
    }
    const auto steps = static_cast<double>(saved);
    return duration_.longer_is_truer ? steps : -steps;
}

diag::Result<const Compiled*> DurationScorer::with(std::uint32_t steps) {
    if (const auto known = plans_.find(steps); known != plans_.end()) return &known->second;
    if (plans_.size() >= kMostPlans) plans_.clear();
    check::Model model = model_;
    check::set_duration(model, model.monitors[0], steps);
    diag::Sink sink;
    auto compiled = compile(std::move(model), {}, sink);
    if (!compiled)
        return diag::Failure{Code::no_threshold,
                             fmt::format("'{}' cannot be compiled with a duration of {}: {}",
                                         model_.monitors[0].name, counted(steps, "step"),
                                         sink.sorted().front().message)};
    return &plans_.emplace(steps, std::move(*compiled)).first->second;
}

diag::Result<bool> DurationScorer::is_violated(std::uint32_t steps) {
    const auto compiled = with(steps);
    if (!compiled) return compiled.failure();
    execute::Evaluator evaluator((*compiled)->plan);
    std::vector<std::optional<Ends>> now(model_.predicates.size());
    evaluator.replace_predicate_values([&](Index p) {
        return etlmon::Value{now[p]->low, now[p]->high};
    });
    std::vector<execute::Sample> samples(model_.inputs.size());
    const auto first = model_.inputs.size() - predicates_.size();
    for (std::uint32_t step = 0; step < steps_; ++step) {
        for (std::size_t i = 0; i < predicates_.size(); ++i) {
            now[predicates_[i]] = values_[step * predicates_.size() + i];
            set(samples[first + i], now[predicates_[i]].has_value(), 0);
        }
        for (std::size_t i = 0; i < flags_.size(); ++i) {
            const std::optional<bool> flag = bools_[step * flags_.size() + i];
            set(samples[flags_[i]], flag.has_value(), flag.value_or(false) ? 1.0F : 0.0F);
        }
        if (evaluator.step(samples)[0].upper < 0) return true;
    }
    return false;
}

// ---- the duration -------------------------------------------------------------------------------

void Times::add(double score, std::uint32_t group) {
    const auto [place, is_new] = places.try_emplace(group, worst.size());
    if (is_new) worst.push_back(score);
    worst[place->second] = std::max(worst[place->second], score);
}

std::optional<thresholds::Entry> fit_duration(const check::Monitor& monitor, const Times& times,
                                              diag::Sink& sink) {
    const check::Duration& duration = *monitor.duration;
    const check::Threshold& threshold = duration.threshold;
    const char* const each = times.by_group ? "group" : "demonstration";
    std::vector<double> scores = times.worst;
    std::sort(scores.begin(), scores.end());
    thresholds::Entry entry;
    entry.method = "conformal";
    entry.alpha = threshold.alpha;
    entry.n = scores.size();
    entry.k = check::rank(threshold.alpha, entry.n);
    if (entry.k > entry.n) {
        sink.report(
            Code::too_few_scores, threshold.span,
            fmt::format("alpha = {} needs the times of at least {}; there {} {}", threshold.alpha,
                        counted(check::scores_needed(threshold.alpha), each),
                        entry.n == 1 ? "is" : "are", entry.n));
        return std::nullopt;
    }
    const double score = scores[entry.k - 1];
    if (std::isinf(score)) {
        const auto count =
            static_cast<std::uint64_t>(std::count(scores.begin(), scores.end(), score));
        const std::string number = fmt::format("{} of {}", count, counted(entry.n, each));
        auto& error = sink.report(
            Code::no_threshold, threshold.span,
            score > 0 ? fmt::format("'{}' is violated for good in {}, whatever this time is, and "
                                    "alpha = {} allows {}",
                                    monitor.name, number, threshold.alpha, entry.n - entry.k)
                      : fmt::format("no limit is needed: in {}, no time violates '{}'", number,
                                    monitor.name));
        error.note(score > 0 ? "calibrate on demonstrations that succeed, or allow a greater alpha"
                             : "remove the monitor, or choose a smaller alpha");
        return std::nullopt;
    }
    entry.duration = static_cast<std::uint64_t>(std::abs(score));
    if (!duration.longer_is_truer) {
        std::reverse(scores.begin(), scores.end());
        for (double& one : scores) one = 0 - one;
    }
    entry.scores = std::move(scores);
    return entry;
}

void set_calibrated(check::Model& model, check::Monitor& monitor, const thresholds::Entry& entry,
                    bool by_group) {
    check::Duration& duration = *monitor.duration;
    duration.threshold.n = entry.n;
    duration.threshold.k = entry.k;
    duration.threshold.by_group = by_group;
    duration.steps = static_cast<std::uint32_t>(*entry.duration);
    duration.is_known = true;
    check::set_duration(model, monitor, duration.steps);
}

std::string describe_duration(const check::Model& model, const check::Monitor& monitor,
                              const thresholds::Entry& entry) {
    std::string text =
        fmt::format("\n{}: {}\n    {}\n", monitor.name, check::shown(model, monitor.formula),
                    check::of_duration(model, *monitor.duration));
    for (const check::Guarantee& one : check::guarantees(model, monitor))
        text += fmt::format("    {}\n", check::text(one));
    const auto time = [](double score) {
        return std::isinf(score) ? std::string(score > 0 ? "any" : "none")
                                 : fmt::format("{}", score);
    };
    const std::vector<double>& scores = entry.scores;
    const bool is_least = monitor.duration->longer_is_truer;
    const auto steps = static_cast<double>(monitor.duration->steps);
    const auto beyond = std::count_if(scores.begin(), scores.end(), [&](double score) {
        return is_least ? score > steps : score < steps;
    });
    return text + fmt::format(
                      "    {} times without an alarm: {} to {} steps, median {}; {} of {} {} "
                      "violated for good with it\n",
                      is_least ? "least" : "greatest", time(scores.front()), time(scores.back()),
                      time(scores[(scores.size() - 1) / 2]), beyond, entry.n,
                      beyond == 1 ? "is" : "are");
}

}  // namespace etlc::calibrate
