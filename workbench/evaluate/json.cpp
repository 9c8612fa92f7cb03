// Evaluations for programs: docs/evaluation.md lists the keys. A figure that is not defined is
// null.
#include <fmt/format.h>

#include "evaluate/evaluate.hpp"
#include "source/escape.hpp"

namespace etlc::evaluate {

namespace {

/// An object, a member a line.
class Object {
public:
    explicit Object(std::size_t indent) : indent_(indent) {}

    Object& raw(const std::string& key, const std::string& value) {
        text_ += fmt::format("{}\n{:{}}{}: {}", text_.empty() ? "" : ",", "", indent_ + 2,
                             source::json_string(key), value);
        return *this;
    }
    Object& number(const std::string& key, const std::optional<double>& value) {
        return raw(key, value ? fmt::format("{}", *value) : "null");
    }
    Object& count(const std::string& key, std::uint64_t value) {
        return raw(key, std::to_string(value));
    }
    Object& figure(const std::string& key, const Figure& figure) {
        number(key, figure.value);
        if (figure.interval)
            raw(key + "_interval",
                fmt::format("[{}, {}]", figure.interval->low, figure.interval->high));
        return *this;
    }
    std::size_t inner() const { return indent_ + 2; }
    std::string text() const {
        return text_.empty() ? "{}" : fmt::format("{{{}\n{:{}}}}", text_, "", indent_);
    }

private:
    std::size_t indent_;
    std::string text_;
};

/// Of texts that are JSON already.
std::string list(const std::vector<std::string>& items) {
    return fmt::format("[{}]", fmt::join(items, ", "));
}

std::string strings(const std::vector<std::string>& texts) {
    std::vector<std::string> items;
    for (const std::string& text : texts) items.push_back(source::json_string(text));
    return list(items);
}

std::string rates_object(const Rates& rates, std::size_t indent) {
    return Object(indent)
        .number("f1", rates.f1)
        .number("precision", rates.precision)
        .number("recall", rates.recall)
        .number("agreement", rates.agreement)
        .text();
}

Object& add_score(Object& object, const Score& score) {
    const Counts& c = score.counts;
    object.figure("f1", score.f1)
        .figure("precision", score.precision)
        .figure("recall", score.recall);
    object.figure("agreement", score.agreement);
    const auto total = static_cast<double>(c.total());
    object.number("positive_rate", c.total() == 0 ? std::optional<double>{}
                                                  : static_cast<double>(c.positives()) / total);
    object.count("positives", c.positives()).count("negatives", c.negatives());
    object.count("true_positives", c.true_positives).count("false_positives", c.false_positives);
    object.count("false_negatives", c.false_negatives).count("true_negatives", c.true_negatives);
    object.count("unsaid_positives", c.unsaid_positives)
        .count("unsaid_negatives", c.unsaid_negatives);
    object.count("unlabelled", c.unlabelled);
    const auto baseline = [&](const std::string& name, const Rates& blind) {
        object.raw(name, rates_object(blind, object.inner()));
    };
    baseline("always_true", rates_of_constant(true, c.positives(), c.total()));
    baseline("always_false", rates_of_constant(false, c.positives(), c.total()));
    baseline("duration", rates(score.duration.value_or(Counts{})));
    return object;
}

std::string predicate(const PredicateScore& p, std::size_t indent) {
    Object object(indent);
    add_score(object, p.frames).figure("auroc", p.auroc).figure("coverage", p.coverage);
    object.count("unmeasured", p.unmeasured).count("episodes_labelled_by_array", p.arrays);
    return object.text();
}

std::string detection(const Detection& d, const std::optional<double>& step_seconds,
                      std::size_t indent) {
    Object object(indent);
    object.count("turns", d.turns).count("missed", d.missed).count("early", d.early);
    object.figure("mean_steps", d.mean).number("median_steps", d.median);
    if (step_seconds)
        object.number("mean_seconds",
                      d.mean.value ? std::optional(*d.mean.value * *step_seconds) : std::nullopt);
    return object.text();
}

std::string monitor(const MonitorScore& m, const std::optional<double>& step_seconds,
                    std::size_t indent) {
    Object object(indent);
    if (!m.lacking.empty()) {
        return object.raw("evaluable", "false").raw("without_truth", strings(m.lacking)).text();
    }
    object.raw("evaluable", "true");
    object.figure("step_agreement", m.steps.agreement)
        .figure("episode_agreement", m.episodes.agreement);
    if (m.ordering) object.figure("ordering_agreement", m.ordering->agreement);
    Object steps(object.inner());
    Object episodes(object.inner());
    object.raw("steps", add_score(steps, m.steps).text())
        .raw("episodes", add_score(episodes, m.episodes).text());
    if (m.ordering) {
        Object ordering(object.inner());
        object.raw("ordering", add_score(ordering, *m.ordering).text());
    }
    return object.raw("detection", detection(m.detection, step_seconds, object.inner())).text();
}

std::string folds(const Evaluation& evaluation, std::size_t indent) {
    std::vector<std::string> items;
    for (const Judgement::Fold& fold : evaluation.folds) {
        Object object(indent);
        Object thresholds(object.inner());
        for (const auto& [name, threshold] : fold.thresholds)
            thresholds.raw(name, fmt::format("{}", threshold));
        items.push_back(
            object.count("episodes", fold.episodes).raw("thresholds", thresholds.text()).text());
    }
    return list(items);
}

std::string episode(const EpisodeRow& e, std::size_t indent) {
    Object object(indent);
    object.raw("episode", source::json_string(e.path));
    if (e.fold) object.count("fold", *e.fold);
    object.count("frames", e.frames).raw("wrong_verdicts", strings(e.wrong));
    object.number("f1", rates(e.claims).f1).number("agreement", rates(e.claims).agreement);
    Object error(object.inner());
    if (e.first_error)
        error.count("step", e.first_error->step)
            .raw(e.first_error->of_monitor ? "monitor" : "predicate",
                 source::json_string(e.first_error->name));
    object.raw("first_error", e.first_error ? error.text() : "null");
    Object predicates(object.inner());
    for (const auto& [name, frames] : e.predicates)
        predicates.raw(name, rates_object(rates(frames), predicates.inner()));
    return object.raw("predicates", predicates.text()).text();
}

std::string evaluation_object(const Evaluation& evaluation, std::size_t indent) {
    Object top(indent);
    top.count("episodes", evaluation.episodes).count("frames", evaluation.frames);
    top.count("repeated_episodes", evaluation.repeated).count("leaked_episodes", evaluation.leaked);
    top.count("overlapping_episodes", evaluation.overlapping);
    top.raw("reservations", strings(evaluation.reservations));
    top.count("resamples", kResamples);
    if (!evaluation.folds.empty()) top.raw("folds", folds(evaluation, top.inner()));
    Object predicates(top.inner());
    for (const PredicateScore& p : evaluation.predicates)
        predicates.raw(p.name, predicate(p, predicates.inner()));
    Object monitors(top.inner());
    const std::optional<double> seconds =
        evaluation.step_seconds > 0 ? std::optional(evaluation.step_seconds) : std::nullopt;
    for (const MonitorScore& m : evaluation.monitors)
        monitors.raw(m.name, monitor(m, seconds, monitors.inner()));
    top.raw("predicates", predicates.text()).raw("monitors", monitors.text());
    if (!evaluation.by_episode.empty()) {
        std::vector<std::string> rows;
        for (const EpisodeRow& row : evaluation.by_episode)
            rows.push_back(episode(row, top.inner()));
        top.raw("by_episode", list(rows));
    }
    return top.text();
}

std::string difference(const Difference& d, const std::string& spec, const std::string& first,
                       std::size_t indent) {
    Object object(indent);
    object.raw("spec", source::json_string(spec)).raw("less", source::json_string(first));
    object.raw(d.of_monitor ? "monitor" : "predicate", source::json_string(d.name));
    object.raw("level", source::json_string(d.level));
    object.count("episodes_of_other_truth", d.other_truths);
    if (d.other_truths > 0) return object.text();
    object.figure("f1", d.f1).figure("precision", d.precision);
    object.figure("recall", d.recall).figure("agreement", d.agreement);
    if (d.auroc) object.figure("auroc", *d.auroc);
    return object.text();
}

}  // namespace

std::string json(const SideBySide& specs) {
    const auto& all = specs.specs;
    if (all.size() == 1) return evaluation_object(all[0].evaluation, 0) + "\n";
    Object top(0);
    Object evaluations(top.inner());
    std::vector<std::string> differences;
    for (const SideBySide::Spec& spec : all) {
        evaluations.raw(spec.path, evaluation_object(spec.evaluation, evaluations.inner()));
        for (const Difference& d : spec.differences)
            differences.push_back(difference(d, spec.path, all[0].path, top.inner()));
    }
    return top.raw("specs", evaluations.text()).raw("differences", list(differences)).text() + "\n";
}

}  // namespace etlc::evaluate
