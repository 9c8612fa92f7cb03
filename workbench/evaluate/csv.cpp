// Evaluations for spreadsheets: `kind,name,level,figure,value,low,high`, a figure a row, or a row
// an episode; empty where there is none. With several specs the spec comes first.
#include <fmt/format.h>

#include <algorithm>

#include "evaluate/evaluate.hpp"
#include "source/escape.hpp"

namespace etlc::evaluate {

namespace {

std::string cell(const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : "";
}

class Rows {
public:
    /// `prefix`: of every row, with its comma.
    explicit Rows(std::string prefix) : prefix_(std::move(prefix)) {}

    void row(const std::string& what, const std::string& figure, const std::optional<double>& value,
             const std::optional<Interval>& interval = {}) {
        text_ += fmt::format("{}{},{},{},{},{}\n", prefix_, what, figure, cell(value),
                             interval ? fmt::format("{}", interval->low) : "",
                             interval ? fmt::format("{}", interval->high) : "");
    }
    void row(const std::string& what, const std::string& figure, const Figure& value) {
        row(what, figure, value.value, value.interval);
    }
    void count(const std::string& what, const std::string& figure, std::uint64_t value) {
        text_ += fmt::format("{}{},{},{},,\n", prefix_, what, figure, value);
    }

    void score(const std::string& what, const Score& score) {
        row(what, "f1", score.f1);
        row(what, "precision", score.precision);
        row(what, "recall", score.recall);
        row(what, "agreement", score.agreement);
        const Counts& c = score.counts;
        count(what, "true_positives", c.true_positives);
        count(what, "false_positives", c.false_positives);
        count(what, "false_negatives", c.false_negatives);
        count(what, "true_negatives", c.true_negatives);
        count(what, "unsaid_positives", c.unsaid_positives);
        count(what, "unsaid_negatives", c.unsaid_negatives);
        count(what, "unlabelled", c.unlabelled);
        const auto baseline = [&](const std::string& name, const Rates& blind) {
            row(what, name + "_f1", blind.f1);
            row(what, name + "_agreement", blind.agreement);
        };
        baseline("always_true", rates_of_constant(true, c.positives(), c.total()));
        baseline("always_false", rates_of_constant(false, c.positives(), c.total()));
        baseline("duration", rates(score.duration.value_or(Counts{})));
    }

    std::string take() { return std::move(text_); }

private:
    std::string prefix_;
    std::string text_;
};

void add_folds(Rows& rows, const std::vector<Judgement::Fold>& folds) {
    for (std::size_t k = 0; k < folds.size(); ++k) {
        const std::string fold = fmt::format("fold,{}", k + 1);
        rows.count(fold + ",", "episodes", folds[k].episodes);
        for (const auto& [name, threshold] : folds[k].thresholds)
            rows.row(fmt::format("{},{}", fold, name), "threshold", threshold);
    }
}

void add_evaluation(Rows& rows, const Evaluation& evaluation) {
    for (const PredicateScore& p : evaluation.predicates) {
        const std::string what = fmt::format("predicate,{},frames", p.name);
        rows.score(what, p.frames);
        rows.row(what, "auroc", p.auroc);
        rows.row(what, "coverage", p.coverage);
    }
    for (const MonitorScore& m : evaluation.monitors) {
        if (!m.lacking.empty()) continue;
        rows.score(fmt::format("monitor,{},steps", m.name), m.steps);
        const std::string episodes = fmt::format("monitor,{},episodes", m.name);
        rows.score(episodes, m.episodes);
        rows.count(episodes, "turns", m.detection.turns);
        rows.count(episodes, "turns_missed", m.detection.missed);
        rows.count(episodes, "turns_early", m.detection.early);
        rows.row(episodes, "delay_mean_steps", m.detection.mean);
        rows.row(episodes, "delay_median_steps", m.detection.median);
        if (m.ordering) rows.score(fmt::format("monitor,{},ordering", m.name), *m.ordering);
    }
    add_folds(rows, evaluation.folds);
}

void add_differences(Rows& rows, const std::vector<Difference>& differences) {
    for (const Difference& d : differences) {
        const std::string what =
            fmt::format("{},{},{}", d.of_monitor ? "monitor" : "predicate", d.name, d.level);
        rows.count(what, "episodes_of_other_truth", d.other_truths);
        if (d.other_truths > 0) continue;
        rows.row(what, "f1", d.f1);
        rows.row(what, "precision", d.precision);
        rows.row(what, "recall", d.recall);
        rows.row(what, "agreement", d.agreement);
        if (d.auroc) rows.row(what, "auroc", *d.auroc);
    }
}

/// Of all specs, each once, in the order in which they come up.
std::vector<std::string> predicates_of(const SideBySide& specs) {
    std::vector<std::string> names;
    for (const SideBySide::Spec& spec : specs.specs)
        for (const PredicateScore& p : spec.evaluation.predicates)
            if (std::find(names.begin(), names.end(), p.name) == names.end())
                names.push_back(p.name);
    return names;
}

/// `predicates`: whose F1 and agreement stand at the end of the row, where the spec has them.
std::string row_of(const EpisodeRow& e, const std::vector<std::string>& predicates) {
    const Rates of_claims = rates(e.claims);
    std::string text =
        fmt::format("{},{},{},{},{},{},{},{},{}", source::csv_cell(e.path),
                    e.fold ? std::to_string(*e.fold) : "", e.frames, e.wrong.size(),
                    fmt::join(e.wrong, " "), cell(of_claims.f1), cell(of_claims.agreement),
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

std::string csv(const SideBySide& specs) {
    const auto& all = specs.specs;
    const bool several = all.size() > 1;
    std::string text = several ? "spec,less," : "";
    text += "kind,name,level,figure,value,low,high\n";
    for (const SideBySide::Spec& spec : all) {
        const std::string path = source::csv_cell(spec.path);
        Rows rows(several ? path + ",," : "");
        add_evaluation(rows, spec.evaluation);
        text += rows.take();
        Rows differences(path + "," + source::csv_cell(all[0].path) + ",");
        add_differences(differences, spec.differences);
        text += differences.take();
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
