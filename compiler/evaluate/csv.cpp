// The evaluation for spreadsheets: `kind,name,level,figure,value,low,high`, a figure a row; empty
// where there is none.
#include <fmt/format.h>

#include "evaluate/evaluate.hpp"

namespace etlc::evaluate {

namespace {

class Rows {
public:
    void row(const std::string& what, const std::string& figure, const std::optional<double>& value,
             const std::optional<Interval>& interval = {}) {
        text_ +=
            fmt::format("{},{},{},{},{}\n", what, figure, value ? fmt::format("{}", *value) : "",
                        interval ? fmt::format("{}", interval->low) : "",
                        interval ? fmt::format("{}", interval->high) : "");
    }
    void row(const std::string& what, const std::string& figure, const Figure& value) {
        row(what, figure, value.value, value.interval);
    }
    void count(const std::string& what, const std::string& figure, std::uint64_t value) {
        text_ += fmt::format("{},{},{},,\n", what, figure, value);
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
        for (const bool claim : {true, false}) {
            const Rates blind = rates_of_constant(claim, c.positives(), c.total());
            const std::string name = claim ? "always_true_" : "always_false_";
            row(what, name + "f1", blind.f1);
            row(what, name + "agreement", blind.agreement);
        }
    }

    std::string take() { return std::move(text_); }

private:
    std::string text_ = "kind,name,level,figure,value,low,high\n";
};

}  // namespace

std::string csv(const Evaluation& evaluation) {
    Rows rows;
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
    return rows.take();
}

}  // namespace etlc::evaluate
