// The evaluation for programs: docs/data.md lists the keys. A figure that is not defined is null.
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

std::string blind(bool claim, const Counts& counts, std::size_t indent) {
    const Rates rates = rates_of_constant(claim, counts.positives(), counts.total());
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
    object.raw("always_true", blind(true, c, object.inner()))
        .raw("always_false", blind(false, c, object.inner()));
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
        std::string names;
        for (const std::string& name : m.lacking)
            names += (names.empty() ? "" : ", ") + source::json_string(name);
        return object.raw("evaluable", "false").raw("without_truth", "[" + names + "]").text();
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

}  // namespace

std::string json(const Evaluation& evaluation) {
    Object top(0);
    top.count("episodes", evaluation.episodes).count("frames", evaluation.frames);
    top.count("repeated_episodes", evaluation.repeated).count("leaked_episodes", evaluation.leaked);
    top.count("overlapping_episodes", evaluation.overlapping);
    std::string reservations;
    for (const std::string& one : evaluation.reservations)
        reservations += (reservations.empty() ? "" : ", ") + source::json_string(one);
    top.raw("reservations", "[" + reservations + "]");
    top.count("resamples", kResamples);
    Object predicates(top.inner());
    for (const PredicateScore& p : evaluation.predicates)
        predicates.raw(p.name, predicate(p, predicates.inner()));
    Object monitors(top.inner());
    const std::optional<double> seconds =
        evaluation.step_seconds > 0 ? std::optional(evaluation.step_seconds) : std::nullopt;
    for (const MonitorScore& m : evaluation.monitors)
        monitors.raw(m.name, monitor(m, seconds, monitors.inner()));
    return top.raw("predicates", predicates.text()).raw("monitors", monitors.text()).text() + "\n";
}

}  // namespace etlc::evaluate
