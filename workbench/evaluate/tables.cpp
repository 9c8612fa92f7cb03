// Evaluations for people: aligned tables, with the baselines below each score. With several specs,
// the tables of each follow each other.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>

#include "evaluate/evaluate.hpp"

namespace etlc::evaluate {

namespace {

using episodes::shown;
using Row = std::vector<std::string>;

constexpr std::size_t kMostEpisodes = 20;  ///< rows of the table by episode

/// Returns the number of code points, by which a terminal aligns.
std::size_t width(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;
    }));
}

/// Aligns the first column left and the others right, two blanks apart.
std::string aligned(const std::vector<Row>& rows) {
    std::vector<std::size_t> widths;
    for (const Row& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
    }
    std::string text;
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string pad(widths[i] - width(row[i]), ' ');
            line += i == 0 ? row[i] + pad : "  " + pad + row[i];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string difference(const Figure& f) {
    if (!f.value) return "-";
    std::string text = fmt::format("{:+.3f}", *f.value);
    if (f.interval) text += fmt::format(" [{:+.3f}, {:+.3f}]", f.interval->low, f.interval->high);
    return text;
}

std::string percent(std::uint64_t part, std::uint64_t whole) {
    if (whole == 0) return "-";
    return fmt::format("{:.2f} %", 100 * static_cast<double>(part) / static_cast<double>(whole));
}

Row heading(const std::string& what, const std::string& positive) {
    return {what, "F1", "precision", "recall", "agreement", positive};
}

void add_figures(std::vector<Row>& rows, const std::string& name, const Score& score) {
    const Counts& c = score.counts;
    Row row{name};
    score.for_each([&](const char*, const Figure& rate) { row.push_back(shown(rate)); });
    row.push_back(
        fmt::format("{} of {} ({})", c.positives(), c.total(), percent(c.positives(), c.total())));
    rows.push_back(std::move(row));
}

void add_baselines(std::vector<Row>& rows, const Score& score) {
    for (auto [what, blind] : baselines(score)) {
        std::replace(what.begin(), what.end(), '_', ' ');
        Row& baseline = rows.emplace_back(Row{"  " + what});
        blind.for_each([&](const char*, const auto& rate) { baseline.push_back(shown(rate)); });
    }
}

void add(std::vector<Row>& rows, const std::string& name, const Score& score) {
    add_figures(rows, name, score);
    add_baselines(rows, score);
}

/// Adds a line for cases without a known truth.
void add_remarks(std::string& text, const std::string& name, const Counts& counts,
                 const std::string& unit) {
    if (counts.unlabelled > 0)
        text += fmt::format("{}: {} of unknown truth left out\n", name,
                            diag::counted(counts.unlabelled, unit));
}

/// The unknown predictions beside both errors. Nothing is printed where every prediction is known.
class Errors {
public:
    void add(const std::string& name, const Score& score, const Coverage* coverage = nullptr) {
        const Counts& c = score.counts;
        any_ |= c.unknown() > 0;
        Row row{name};
        score.for_each_error([&](const char*, const Figure& rate) { row.push_back(shown(rate)); });
        if (coverage)
            for (const Figure* share : {&coverage->of_positives, &coverage->of_negatives})
                row.push_back(shown(*share));
        else
            for (const auto& [right, wrong, unknown] :
                 {std::tuple(c.true_positives, c.false_negatives, c.unknown_positives),
                  std::tuple(c.true_negatives, c.false_positives, c.unknown_negatives)})
                row.push_back(fmt::format("{} right, {} wrong, {} unknown", right, wrong, unknown));
        rows_.push_back(std::move(row));
        of_episodes_ = coverage != nullptr;
    }

    std::string text() const {
        if (!any_) return "";
        std::vector<Row> rows{{"unknown, which agrees with nothing", "unknown",
                               "wrong when decided", "false where true", "true where false"}};
        for (const char* of : {"true", "false"})
            rows[0].push_back(of_episodes_ ? fmt::format("episodes, none wrong where {}", of)
                                           : fmt::format("truly {}", of));
        rows.insert(rows.end(), rows_.begin(), rows_.end());
        return aligned(rows);
    }

private:
    std::vector<Row> rows_;
    bool any_ = false;
    bool of_episodes_ = false;
};

std::string predicates_part(const Evaluation& evaluation) {
    std::vector<Row> rows = {heading("predicate, by frames", "frames inside")};
    rows[0].push_back("AUROC");
    rows[0].push_back("episodes without a miss");
    std::string remarks;
    Errors errors;
    for (const PredicateScore& p : evaluation.predicates) {
        const std::size_t first = rows.size();
        add(rows, p.name, p.frames);
        rows[first].push_back(shown(p.auroc));
        rows[first].push_back(shown(p.coverage.of_positives));
        errors.add(p.name, p.frames, &p.coverage);
        add_remarks(remarks, p.name, p.frames.counts, "frame");
        if (p.adaptive)
            remarks += fmt::format(
                "{}: evaluated with its initial threshold, which labels would adapt\n", p.name);
        if (p.arrays > 0)
            remarks += fmt::format("{}: labels come with {} of the episodes, not from the spec\n",
                                   p.name, p.arrays);
    }
    return "\n" + aligned(rows) + errors.text() + remarks;
}

std::string monitors_part(const Evaluation& evaluation, const std::string& what,
                          const std::string& positive, Score MonitorScore::*level,
                          const char* unit) {
    std::vector<Row> rows = {heading(what, positive)};
    std::string remarks;
    Errors errors;
    for (const MonitorScore& m : evaluation.monitors) {
        if (!m.lacking.empty()) continue;
        add(rows, m.name, m.*level);
        errors.add(m.name, m.*level, level == &MonitorScore::steps ? &m.coverage : nullptr);
        add_remarks(remarks, m.name, (m.*level).counts, unit);
    }
    return rows.size() == 1 ? "" : "\n" + aligned(rows) + errors.text() + remarks;
}

/// Lists how many variants there are, and the rates of each kind under those of all.
std::string variants_part(const Evaluation& evaluation) {
    std::vector<std::string> made;
    std::vector<std::string> left_out;
    for (const VariantsMade& kind : evaluation.variants) {
        made.push_back(fmt::format("{} {}", kind.made, episodes::name_of(kind.variant)));
        if (kind.left_out > 0)
            left_out.push_back(
                fmt::format("{} {}", kind.left_out, episodes::name_of(kind.variant)));
    }
    std::vector<Row> rows = {heading("monitor, by broken variants", "satisfied")};
    std::string remarks;
    Errors errors;
    for (const MonitorScore& m : evaluation.monitors) {
        if (m.variants.empty()) continue;
        const Score& all = m.variants.back();
        add_figures(rows, m.name, all);
        errors.add(m.name, all);
        for (std::size_t v = 0; v < evaluation.variants.size(); ++v)
            add_figures(rows,
                        fmt::format("  {}", episodes::name_of(evaluation.variants[v].variant)),
                        m.variants[v]);
        add_baselines(rows, all);
        add_remarks(remarks, m.name, all.counts, "variant");
    }
    if (rows.size() == 1) return "";
    std::string text =
        fmt::format("\nbroken variants of the episodes: {}\n", fmt::join(made, ", "));
    if (!left_out.empty())
        text += fmt::format("episodes too short, or without a change of a truth: {}\n",
                            fmt::join(left_out, ", "));
    return text + aligned(rows) + errors.text() + remarks;
}

std::string ordering_part(const Evaluation& evaluation) {
    std::vector<Row> rows = {{"ordering, where all stages were visited", "agreement",
                              "episodes in order", "in another order"}};
    for (const MonitorScore& m : evaluation.monitors)
        if (m.ordering)
            rows.push_back({m.name, shown(m.ordering->agreement),
                            std::to_string(m.ordering->counts.positives()),
                            std::to_string(m.ordering->counts.negatives())});
    return rows.size() == 1 ? "" : "\n" + aligned(rows);
}

std::string steps(const std::optional<double>& value) {
    return value ? fmt::format("{:+.1f}", *value) : "-";
}

std::string detection_part(const Evaluation& evaluation) {
    std::vector<Row> rows = {
        {"time to detection, steps", "true turns", "missed", "early", "median", "mean"}};
    if (evaluation.step_seconds > 0) rows[0].emplace_back("mean, s");
    for (const MonitorScore& m : evaluation.monitors) {
        if (!m.lacking.empty()) continue;
        const Detection& d = m.detection;
        std::string mean = steps(d.mean.value);
        if (d.mean.interval)
            mean += fmt::format(" [{:+.1f}, {:+.1f}]", d.mean.interval->low, d.mean.interval->high);
        rows.push_back({m.name, std::to_string(d.turns), std::to_string(d.missed),
                        std::to_string(d.early), steps(d.median), mean});
        if (evaluation.step_seconds > 0)
            rows.back().push_back(
                d.mean.value ? fmt::format("{:+.3f}", *d.mean.value * evaluation.step_seconds)
                             : "-");
    }
    return rows.size() == 1 ? "" : "\n" + aligned(rows);
}

/// Compares the monitors as detectors of failures.
std::string outcomes_part(const Evaluation& evaluation) {
    const double step = evaluation.step_seconds > 0 ? evaluation.step_seconds : 1;
    const char* const unit = evaluation.step_seconds > 0 ? "s" : "steps";
    std::vector<Row> rows = {{"monitor, by outcome", "false alarms", "detected",
                              "balanced accuracy", "AUROC",
                              fmt::format("warning, {}: median", unit), "quartiles"}};
    const auto time = [&](const std::optional<double>& steps) {
        return steps ? fmt::format("{:.4g}", *steps * step) : "-";
    };
    const auto count = [](std::uint64_t part, std::uint64_t whole, const Figure& of) {
        return fmt::format("{} of {}, {}", part, whole, shown(of));
    };
    std::uint64_t known = 0;
    for (const MonitorScore& m : evaluation.monitors) {
        if (!m.outcomes) continue;
        const OutcomeScore& o = *m.outcomes;
        known = o.successes + o.failures;
        const Figure& median = o.warning_median;
        std::string warning = time(median.value);
        if (median.interval)
            warning +=
                fmt::format(" [{}, {}]", time(median.interval->low), time(median.interval->high));
        rows.push_back({m.name, count(o.false_alarm_count, o.successes, o.false_alarms),
                        count(o.detected_count, o.failures, o.detected), shown(o.balanced_accuracy),
                        shown(o.auroc), warning,
                        !median.value
                            ? "-"
                            : fmt::format("{} to {}", time(o.warning_lower_quartile.value),
                                          time(o.warning_upper_quartile.value))});
    }
    if (rows.size() == 1) return "";
    for (const MonitorScore& m : evaluation.monitors) {
        if (!m.outcomes) continue;
        for (const auto& [name, blind] : m.outcomes->baselines) {
            Row& row = rows.emplace_back(Row{"  " + name});
            blind.for_each([&](const char*, const auto& rate) { row.push_back(shown(rate)); });
        }
        break;  // they are the same for all monitors
    }
    std::string text = "\n" + aligned(rows);
    if (known < evaluation.episodes)
        text += fmt::format("{} of unknown outcome left out\n",
                            diag::counted(evaluation.episodes - known, "episode"));
    return text;
}

std::string left_out(const Evaluation& evaluation) {
    std::string text;
    for (const MonitorScore& m : evaluation.monitors) {
        if (m.lacking.empty() || m.outcomes) continue;
        text += fmt::format("{}: not evaluated, no labels for {}\n", m.name,
                            fmt::join(m.lacking, ", "));
    }
    return text.empty() ? "" : "\n" + text;
}

/// Lists the number of episodes that each fold held out, and the thresholds from the others.
std::string folds_part(const Evaluation& evaluation) {
    std::vector<Row> rows = {{"fold", "episodes held out"}};
    for (const auto& [name, threshold] : evaluation.folds[0].thresholds)
        rows[0].push_back(fmt::format("{} of the others", name));
    for (std::size_t k = 0; k < evaluation.folds.size(); ++k) {
        const Conditions::Fold& fold = evaluation.folds[k];
        rows.push_back({std::to_string(k + 1), std::to_string(fold.episodes)});
        for (const auto& [name, threshold] : fold.thresholds)
            rows.back().push_back(fmt::format("{:.7g}", threshold));
    }
    const std::string how =
        evaluation.only_trained > 0
            ? fmt::format(
                  "{} before these only train; every fold is judged by monitors that have "
                  "seen what comes before it",
                  diag::counted(evaluation.only_trained, "episode"))
            : "every episode is judged by monitors that have not seen its fold";
    return fmt::format("{}: {}; no guarantee follows\n\n{}",
                       diag::counted(evaluation.folds.size(), "fold"), how, aligned(rows));
}

std::string by_episode_part(const Evaluation& evaluation) {
    const auto& episodes = evaluation.by_episode;
    std::vector<Row> rows = {{"by episode, the worst first", "frames", "F1", "agreement",
                              "first error", "wrong verdicts"}};
    for (std::size_t i = 0; i < std::min(episodes.size(), kMostEpisodes); ++i) {
        const EpisodeRow& e = episodes[i];
        const Rates of_predictions = rates(e.predictions);
        rows.push_back({e.path, std::to_string(e.frames), shown(of_predictions.f1),
                        shown(of_predictions.agreement),
                        e.first_error
                            ? fmt::format("step {}: {}", e.first_error->step, e.first_error->name)
                            : "-",
                        e.wrong.empty() ? "-" : fmt::format("{}", fmt::join(e.wrong, ", "))});
    }
    std::string text = "\n" + aligned(rows);
    if (episodes.size() > kMostEpisodes)
        text += fmt::format("{} more are not shown; --json and --csv write all {}\n",
                            episodes.size() - kMostEpisodes, episodes.size());
    return text;
}

std::string tables(const Evaluation& evaluation) {
    const auto& groups = evaluation.groups;
    std::string text = fmt::format(
        "{}{}, {}; in brackets 95 % intervals from {} resamples of the {}\n",
        diag::counted(evaluation.episodes, "episode"),
        groups ? " in " + diag::counted(*groups, "group") : "",
        diag::counted(evaluation.frames, "frame"), kResamples, groups ? "groups" : "episodes");
    if (evaluation.repeated > 0)
        text += fmt::format(
            "{} of the episodes repeat another's content: the intervals are too narrow\n",
            evaluation.repeated);
    if (evaluation.overlapping > 0)
        text += fmt::format(
            "{} of the episodes share most of their content with another: the intervals are too "
            "narrow\n",
            evaluation.overlapping);
    for (const std::string& reservation : evaluation.reservations) text += reservation + "\n";
    if (evaluation.leaked > 0)
        text += fmt::format(
            "{} of the episodes {} a target among the frames: the figures are better than on "
            "others\n",
            evaluation.leaked, evaluation.leaked == 1 ? "has" : "have");
    if (!evaluation.folds.empty()) text += folds_part(evaluation);
    if (!evaluation.predicates.empty()) text += predicates_part(evaluation);
    text +=
        monitors_part(evaluation, "monitor, by steps", "satisfied", &MonitorScore::steps, "step");
    text += monitors_part(evaluation, "monitor, by episodes", "satisfied", &MonitorScore::episodes,
                          "episode");
    text += variants_part(evaluation);
    text += ordering_part(evaluation) + detection_part(evaluation) + outcomes_part(evaluation) +
            left_out(evaluation);
    return evaluation.by_episode.empty() ? text : text + by_episode_part(evaluation);
}

std::string differences_part(const SideBySide::Spec& spec, const std::string& first) {
    std::vector<Row> rows = {{fmt::format("{} less {}", spec.path, first), "F1", "precision",
                              "recall", "agreement", "AUROC"}};
    std::string remarks;
    for (const Difference& d : spec.differences) {
        const std::string name = fmt::format("{}, by {}", d.name, d.level);
        if (d.other_truths > 0) {
            remarks +=
                fmt::format("{}: not compared, {} of the episodes {} a different truth in {}\n",
                            name, d.other_truths, d.other_truths == 1 ? "has" : "have", spec.path);
            continue;
        }
        Row& row = rows.emplace_back(Row{name});
        d.for_each([&](const char*, const Figure& rate) { row.push_back(difference(rate)); });
        row.push_back(d.auroc ? difference(*d.auroc) : "");
    }
    if (spec.differences.empty())
        remarks =
            "nothing to compare: the specs have no predicate or monitor with a truth in common\n";
    return "\n" + aligned(rows) + remarks;
}

}  // namespace

std::string table(const SideBySide& specs) {
    const auto& all = specs.specs;
    if (all.size() == 1) return tables(all[0].evaluation);
    std::string text;
    for (const SideBySide::Spec& spec : all)
        text +=
            fmt::format("{}{}\n{}", text.empty() ? "" : "\n", spec.path, tables(spec.evaluation));
    for (std::size_t s = 1; s < all.size(); ++s) text += differences_part(all[s], all[0].path);
    return text;
}

}  // namespace etlc::evaluate
