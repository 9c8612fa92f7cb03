// Evaluations as JSON for programs and as CSV for spreadsheets, whose keys docs/calibration.md
// lists. An undefined figure is null in JSON and an empty cell in CSV. With several specs, the spec
// is the first column.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <concepts>

#include "evaluate/evaluate.hpp"
#include "source/text.hpp"

namespace etlc::evaluate {

namespace {

/// Joins JSON texts to an array.
std::string array(const std::vector<std::string>& items) {
    return fmt::format("[{}]", fmt::join(items, ", "));
}

/// A JSON object with one member per line.
class Object {
public:
    explicit Object(std::size_t indent) : indent_(indent) {}

    void raw(const std::string& key, const std::string& json) {
        text_ += fmt::format("{}\n{:{}}{}: {}", text_.empty() ? "" : ",", "", indent_ + 2,
                             source::json_string(key), json);
    }
    void operator()(const std::string& key, const std::optional<double>& value) {
        raw(key, value ? fmt::format("{}", *value) : "null");
    }
    void operator()(const std::string& key, const Figure& figure) {
        (*this)(key, figure.value);
        if (figure.interval)
            raw(key + "_interval",
                fmt::format("[{}, {}]", figure.interval->low, figure.interval->high));
    }
    void operator()(const std::string& key, std::unsigned_integral auto count) {
        raw(key, std::to_string(count));
    }
    void operator()(const std::string& key, const std::string& text) {
        raw(key, source::json_string(text));
    }
    void operator()(const std::string& key, const std::vector<std::string>& texts) {
        std::vector<std::string> items;
        for (const std::string& text : texts) items.push_back(source::json_string(text));
        raw(key, array(items));
    }
    void operator()(const std::string& key, const Rates& rates) {
        nested(key, [&](Object& object) { rates.for_each(object); });
    }
    /// Adds an object that `fill(object)` fills.
    template <class Fill>
    void nested(const std::string& key, const Fill& fill) {
        Object object(indent_ + 2);
        fill(object);
        raw(key, object.text());
    }
    /// Adds an array of objects that `fill(object, item)` fills.
    template <class Item, class Fill>
    void nested(const std::string& key, const std::vector<Item>& items, const Fill& fill) {
        std::vector<std::string> objects;
        for (const Item& item : items) {
            Object object(indent_ + 2);
            fill(object, item);
            objects.push_back(object.text());
        }
        raw(key, array(objects));
    }
    std::string text() const {
        return text_.empty() ? "{}" : fmt::format("{{{}\n{:{}}}}", text_, "", indent_);
    }

private:
    std::size_t indent_;
    std::string text_;
};

std::string cell(const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : "";
}

/// Rows `kind,name,level,figure,value,low,high`.
class Rows {
public:
    /// `prefix` begins every row and ends with a comma; `what` is "kind,name,level".
    Rows(std::string& text, const std::string& prefix, const std::string& what)
        : text_(text), prefix_(prefix + what + ",") {}

    void operator()(const std::string& figure, const std::optional<double>& value,
                    const std::optional<Interval>& interval = {}) {
        text_ += fmt::format("{}{},{},{},{}\n", prefix_, figure, cell(value),
                             interval ? fmt::format("{}", interval->low) : "",
                             interval ? fmt::format("{}", interval->high) : "");
    }
    void operator()(const std::string& figure, const Figure& value) {
        (*this)(figure, value.value, value.interval);
    }
    void operator()(const std::string& figure, std::unsigned_integral auto count) {
        text_ += fmt::format("{}{},{},,\n", prefix_, figure, count);
    }
    void operator()(const std::string& name, const Rates& rates) {
        (*this)(name + "_f1", rates.f1);
        (*this)(name + "_agreement", rates.agreement);
    }

private:
    std::string& text_;
    std::string prefix_;
};

// Lists of figures for both formats. JSON has a few more.

template <class To>
void list(To&& to, const Score& score) {
    const Counts& c = score.counts;
    score.for_each(to);
    score.for_each_error(to);
    if constexpr (std::is_same_v<To, Object&>) {
        const auto total = static_cast<double>(c.total());
        to("positive_rate",
           c.total() == 0 ? std::optional<double>{} : static_cast<double>(c.positives()) / total);
        to("positives", c.positives());
        to("negatives", c.negatives());
    }
    for (const auto& [name, count] : kCounts) to(name, c.*count);
    for (const auto& [name, rates] : baselines(score)) to(name, rates);
}

/// Calls `visit(name, score)` for the variants of each kind, then for all, which `all` names.
template <class Visit>
void for_each_variant(const Evaluation& evaluation, const MonitorScore& monitor,
                      const std::string& all, const Visit& visit) {
    for (std::size_t v = 0; v < monitor.variants.size(); ++v) {
        const bool is_kind = v < evaluation.variants.size();
        visit(is_kind ? std::string(episodes::name_of(evaluation.variants[v].variant)) : all,
              monitor.variants[v]);
    }
}

template <class To>
void list(To&& to, const Coverage& coverage) {
    to("coverage", coverage.of_positives);
    to("coverage_of_negatives", coverage.of_negatives);
}

template <class To>
void list(To&& to, const PredicateScore& score) {
    list(to, score.frames);
    to("auroc", score.auroc);
    list(to, score.coverage);
    if constexpr (std::is_same_v<To, Object&>) {
        to("unmeasured", score.unmeasured);
        to("episodes_labelled_by_array", score.arrays);
    }
}

template <class To>
void list(To&& to, const Difference& difference) {
    to("episodes_of_other_truth", difference.other_truths);
    if (difference.other_truths > 0) return;
    difference.for_each(to);
    difference.for_each_error(to);
    if (difference.auroc) to("auroc", *difference.auroc);
}

template <class To>
void list(To&& to, const OutcomeScore& o) {
    to("successes", o.successes);
    to("failures", o.failures);
    to("false_alarms", o.false_alarm_count);
    to("detected", o.detected_count);
    o.for_each(to);
    to("auroc", o.auroc);
    to("warning_lower_quartile_steps", o.warning_lower_quartile);
    to("warning_median_steps", o.warning_median);
    to("warning_upper_quartile_steps", o.warning_upper_quartile);
    for (const auto& [baseline, rates] : o.baselines)
        rates.for_each([&, name = baseline](const char* rate, const auto& value) {
            to(fmt::format("{}_{}", name, rate), value);
        });
}

void fill(Object& to, const Detection& d, double step_seconds) {
    to("turns", d.turns);
    to("missed", d.missed);
    to("early", d.early);
    to("mean_steps", d.mean);
    to("median_steps", d.median);
    if (step_seconds > 0)
        to("mean_seconds",
           d.mean.value ? std::optional(*d.mean.value * step_seconds) : std::nullopt);
}

void fill(Object& to, const MonitorScore& m, const Evaluation& evaluation) {
    to.raw("evaluable", m.lacking.empty() ? "true" : "false");
    if (m.outcomes) to.nested("outcomes", [&](Object& object) { list(object, *m.outcomes); });
    if (!m.lacking.empty()) return to("without_truth", m.lacking);
    const auto add_score = [&](const std::string& key, const Score& score) {
        to.nested(key, [&](Object& object) { list(object, score); });
    };
    to("step_agreement", m.steps.agreement);
    to("episode_agreement", m.episodes.agreement);
    if (m.ordering) to("ordering_agreement", m.ordering->agreement);
    to.nested("steps", [&](Object& object) {
        list(object, m.steps);
        list(object, m.coverage);
    });
    add_score("episodes", m.episodes);
    if (m.ordering) add_score("ordering", *m.ordering);
    if (!m.variants.empty())
        to.nested("variants", [&](Object& kinds) {
            for_each_variant(evaluation, m, "all", [&](const std::string& name, const Score& s) {
                kinds.nested(name, [&](Object& object) { list(object, s); });
            });
        });
    to.nested("detection",
              [&](Object& object) { fill(object, m.detection, evaluation.step_seconds); });
}

void fill(Object& to, const Conditions::Fold& fold) {
    to("episodes", fold.episodes);
    to.nested("thresholds", [&](Object& thresholds) {
        for (const auto& [name, threshold] : fold.thresholds)
            thresholds.raw(name,
                           fmt::format("{0}{1}{0}", std::isinf(threshold) ? "\"" : "", threshold));
    });
}

void fill(Object& to, const EpisodeRow& e) {
    const Rates of_predictions = rates(e.predictions);
    to("episode", e.path);
    if (e.fold) to("fold", *e.fold);
    to("frames", e.frames);
    to("wrong_verdicts", e.wrong);
    if (e.outcome != episodes::Outcome::Kind::none) {
        to("outcome", std::string(name_of(e.outcome)));
        to.nested("alarms", [&](Object& alarms) {
            for (const auto& [monitor, step] : e.alarms) alarms(monitor, step);
        });
    }
    to("f1", of_predictions.f1);
    to("agreement", of_predictions.agreement);
    if (e.first_error)
        to.nested("first_error", [&](Object& error) {
            error("step", e.first_error->step);
            error(e.first_error->of_monitor ? "monitor" : "predicate", e.first_error->name);
        });
    else
        to.raw("first_error", "null");
    to.nested("predicates", [&](Object& predicates) {
        for (const auto& [name, frames] : e.predicates) predicates(name, rates(frames));
    });
}

void fill(Object& to, const Evaluation& evaluation) {
    to("episodes", evaluation.episodes);
    if (evaluation.groups) to("groups", *evaluation.groups);
    to("frames", evaluation.frames);
    to("repeated_episodes", evaluation.repeated);
    to("leaked_episodes", evaluation.leaked);
    to("overlapping_episodes", evaluation.overlapping);
    to("reservations", evaluation.reservations);
    to("resamples", kResamples);
    const auto filled = [](Object& object, const auto& item) { fill(object, item); };
    if (evaluation.only_trained > 0) to("only_trained_episodes", evaluation.only_trained);
    if (!evaluation.folds.empty()) to.nested("folds", evaluation.folds, filled);
    if (!evaluation.variants.empty())
        to.nested("variants", [&](Object& all) {
            for (const VariantsMade& kind : evaluation.variants)
                all.nested(std::string(episodes::name_of(kind.variant)), [&](Object& object) {
                    object("made", kind.made);
                    object("without", kind.left_out);
                });
        });
    to.nested("predicates", [&](Object& all) {
        for (const PredicateScore& p : evaluation.predicates)
            all.nested(p.name, [&](Object& object) { list(object, p); });
    });
    to.nested("monitors", [&](Object& all) {
        for (const MonitorScore& m : evaluation.monitors)
            all.nested(m.name, [&](Object& object) { fill(object, m, evaluation); });
    });
    if (!evaluation.by_episode.empty()) to.nested("by_episode", evaluation.by_episode, filled);
}

void add_rows(std::string& text, const std::string& prefix, const Evaluation& evaluation) {
    const auto rows = [&](const std::string& kind, const std::string& name,
                          const std::string& level) {
        return Rows(text, prefix, fmt::format("{},{},{}", kind, name, level));
    };
    for (const PredicateScore& p : evaluation.predicates)
        list(rows("predicate", p.name, "frames"), p);
    for (const MonitorScore& m : evaluation.monitors) {
        if (m.outcomes) list(rows("monitor", m.name, "outcomes"), *m.outcomes);
        if (!m.lacking.empty()) continue;
        list(rows("monitor", m.name, "steps"), m.steps);
        list(rows("monitor", m.name, "steps"), m.coverage);
        Rows episodes = rows("monitor", m.name, "episodes");
        list(episodes, m.episodes);
        episodes("turns", m.detection.turns);
        episodes("turns_missed", m.detection.missed);
        episodes("turns_early", m.detection.early);
        episodes("delay_mean_steps", m.detection.mean);
        episodes("delay_median_steps", m.detection.median);
        if (m.ordering) list(rows("monitor", m.name, "ordering"), *m.ordering);
        for_each_variant(evaluation, m, "variants", [&](const std::string& name, const Score& s) {
            list(rows("monitor", m.name, name), s);
        });
    }
    for (std::size_t k = 0; k < evaluation.folds.size(); ++k) {
        const Conditions::Fold& fold = evaluation.folds[k];
        const std::string number = std::to_string(k + 1);
        rows("fold", number, "")("episodes", fold.episodes);
        for (const auto& [name, threshold] : fold.thresholds)
            rows("fold", number, name.c_str())("threshold", std::optional<double>(threshold));
    }
}

/// Returns the predicates of all specs without repetition, in order of appearance.
std::vector<std::string> predicates_of(const SideBySide& specs) {
    std::vector<std::string> names;
    for (const SideBySide::Spec& spec : specs.specs)
        for (const PredicateScore& p : spec.evaluation.predicates)
            if (std::find(names.begin(), names.end(), p.name) == names.end())
                names.push_back(p.name);
    return names;
}

/// The row ends with F1 and agreement of each of the predicates.
std::string row_of(const EpisodeRow& e, const std::vector<std::string>& predicates) {
    const Rates of_predictions = rates(e.predictions);
    std::string text = fmt::format("{},{},{},{},{},{},{},{},{}", source::csv_cell(e.path),
                                   e.fold ? std::to_string(*e.fold) : "", e.frames, e.wrong.size(),
                                   fmt::join(e.wrong, " "), cell(of_predictions.f1),
                                   cell(of_predictions.agreement),
                                   e.first_error ? std::to_string(e.first_error->step) : "",
                                   e.first_error ? e.first_error->name : "");
    for (const std::string& name : predicates) {
        const auto of = std::find_if(e.predicates.begin(), e.predicates.end(),
                                     [&](const auto& one) { return one.first == name; });
        const Rates here = of == e.predicates.end() ? Rates{} : rates(of->second);
        text += fmt::format(",{},{}", cell(here.f1), cell(here.agreement));
    }
    return text + "\n";
}

}  // namespace

std::string json(const SideBySide& specs) {
    const auto& all = specs.specs;
    Object top(0);
    if (all.size() == 1) {
        fill(top, all[0].evaluation);
        return top.text() + "\n";
    }
    std::vector<std::pair<std::string, Difference>> differences;
    top.nested("specs", [&](Object& evaluations) {
        for (const SideBySide::Spec& spec : all) {
            evaluations.nested(spec.path, [&](Object& one) { fill(one, spec.evaluation); });
            for (const Difference& d : spec.differences) differences.emplace_back(spec.path, d);
        }
    });
    top.nested("differences", differences, [&](Object& object, const auto& difference) {
        const auto& [path, d] = difference;
        object("spec", path);
        object("less", all[0].path);
        object(d.of_monitor ? "monitor" : "predicate", d.name);
        object("level", d.level);
        list(object, d);
    });
    return top.text() + "\n";
}

std::string csv(const SideBySide& specs) {
    const auto& all = specs.specs;
    const bool several = all.size() > 1;
    std::string text = several ? "spec,less," : "";
    text += "kind,name,level,figure,value,low,high\n";
    for (const SideBySide::Spec& spec : all) {
        const std::string path = source::csv_cell(spec.path);
        add_rows(text, several ? path + ",," : "", spec.evaluation);
        for (const Difference& d : spec.differences)
            list(Rows(text, fmt::format("{},{},", path, source::csv_cell(all[0].path)),
                      fmt::format("{},{},{}", d.of_monitor ? "monitor" : "predicate", d.name,
                                  d.level)),
                 d);
    }
    return text;
}

std::string csv_by_episode(const SideBySide& specs) {
    const bool several = specs.specs.size() > 1;
    const std::vector<std::string> predicates = predicates_of(specs);
    std::string text = several ? "spec," : "";
    text += "episode,fold,frames,wrong_verdicts,wrong,f1,agreement,first_error_step,first_error";
    for (const std::string& name : predicates) text += fmt::format(",{0}_f1,{0}_agreement", name);
    text += "\n";
    for (const SideBySide::Spec& spec : specs.specs)
        for (const EpisodeRow& e : spec.evaluation.by_episode)
            text += (several ? source::csv_cell(spec.path) + "," : "") + row_of(e, predicates);
    return text;
}

}  // namespace etlc::evaluate
