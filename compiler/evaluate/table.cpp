// The evaluation for people: aligned columns; every figure with its interval, and beside it what
// blind claims get.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evaluate/evaluate.hpp"

namespace etlc::evaluate {

namespace {

using Row = std::vector<std::string>;

/// Code points, which is what a terminal aligns by.
std::size_t width(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;
    }));
}

/// The first column flush left, the others right, two blanks apart.
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

std::string number(const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : "-";
}

std::string figure(const Figure& f) {
    if (!f.interval) return number(f.value);
    return fmt::format("{} [{:.3f}, {:.3f}]", number(f.value), f.interval->low, f.interval->high);
}

std::string percent(std::uint64_t part, std::uint64_t whole) {
    if (whole == 0) return "-";
    return fmt::format("{:.2f} %", 100 * static_cast<double>(part) / static_cast<double>(whole));
}

Row heading(const std::string& what, const std::string& positive) {
    return {what, "F1", "precision", "recall", "agreement", positive};
}

void add(std::vector<Row>& rows, const std::string& name, const Score& score) {
    const Counts& c = score.counts;
    rows.push_back({name, figure(score.f1), figure(score.precision), figure(score.recall),
                    figure(score.agreement),
                    fmt::format("{} of {} ({})", c.positives(), c.total(),
                                percent(c.positives(), c.total()))});
    for (const bool claim : {true, false}) {
        const Rates blind = rates_of_constant(claim, c.positives(), c.total());
        rows.push_back({claim ? "  always true" : "  always false", number(blind.f1),
                        number(blind.precision), number(blind.recall), number(blind.agreement)});
    }
}

/// What was left out or could not be said, a line each.
void add_remarks(std::string& text, const std::string& name, const Counts& counts,
                 const char* what) {
    if (counts.unlabelled > 0)
        text += fmt::format("{}: {} {} left out, whose truth is unknown\n", name, counts.unlabelled,
                            what);
    if (const std::uint64_t unsaid = counts.unsaid_positives + counts.unsaid_negatives; unsaid > 0)
        text +=
            fmt::format("{}: {} {} that a missing sample leaves open, counted as not agreeing\n",
                        name, unsaid, what);
}

std::string predicates_part(const Evaluation& evaluation) {
    std::vector<Row> rows = {heading("predicate, by frames", "frames inside")};
    rows[0].push_back("AUROC");
    rows[0].push_back("episodes without a miss");
    std::string remarks;
    for (const PredicateScore& p : evaluation.predicates) {
        const std::size_t first = rows.size();
        add(rows, p.name, p.frames);
        rows[first].push_back(figure(p.auroc));
        rows[first].push_back(figure(p.coverage));
        add_remarks(remarks, p.name, p.frames.counts, "frames");
        if (p.adaptive)
            remarks += fmt::format(
                "{}: with the threshold that it starts with; labels would move it\n", p.name);
        if (p.arrays > 0)
            remarks += fmt::format("{}: in {} of the episodes labelled by an array of theirs\n",
                                   p.name, p.arrays);
    }
    return "\n" + aligned(rows) + remarks;
}

std::string monitors_part(const Evaluation& evaluation, const std::string& what,
                          const std::string& positive, Score MonitorScore::*level,
                          const char* unit) {
    std::vector<Row> rows = {heading(what, positive)};
    std::string remarks;
    for (const MonitorScore& m : evaluation.monitors) {
        if (!m.lacking.empty()) continue;
        add(rows, m.name, m.*level);
        add_remarks(remarks, m.name, (m.*level).counts, unit);
    }
    return rows.size() == 1 ? "" : "\n" + aligned(rows) + remarks;
}

std::string ordering_part(const Evaluation& evaluation) {
    std::vector<Row> rows = {{"ordering, where all stages were visited", "agreement",
                              "episodes in order", "in another order"}};
    for (const MonitorScore& m : evaluation.monitors)
        if (m.ordering)
            rows.push_back({m.name, figure(m.ordering->agreement),
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

std::string left_out(const Evaluation& evaluation) {
    std::string text;
    for (const MonitorScore& m : evaluation.monitors) {
        if (m.lacking.empty()) continue;
        std::string names;
        for (const std::string& name : m.lacking) names += (names.empty() ? "" : ", ") + name;
        text += fmt::format("{}: not evaluable without a truth of {}\n", m.name, names);
    }
    return text.empty() ? "" : "\n" + text;
}

}  // namespace

std::string table(const Evaluation& evaluation) {
    std::string text =
        fmt::format("{}, {}; in brackets 95 % intervals from {} resamples of the episodes\n",
                    diag::counted(evaluation.episodes, "episode"),
                    diag::counted(evaluation.frames, "frame"), kResamples);
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
    if (!evaluation.predicates.empty()) text += predicates_part(evaluation);
    text +=
        monitors_part(evaluation, "monitor, by steps", "satisfied", &MonitorScore::steps, "steps");
    text += monitors_part(evaluation, "monitor, by episodes", "satisfied", &MonitorScore::episodes,
                          "episodes");
    return text + ordering_part(evaluation) + detection_part(evaluation) + left_out(evaluation);
}

}  // namespace etlc::evaluate
