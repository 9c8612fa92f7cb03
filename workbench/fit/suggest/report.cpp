// Prints suggestions as text and as JSON.

#include <fmt/format.h>

#include <algorithm>

#include "fit/suggest/suggest.hpp"
#include "source/text.hpp"

namespace etlc::fit {

namespace {

using diag::counted;
using episodes::shown;

std::string row(const Suggestion& one) {
    return fmt::format("{} {:20}  {:>10}  {}{}\n", one.ties ? '*' : ' ', shown(one.auroc),
                       one.elements, one.distance, one.lines.empty() ? " (as it is)" : "");
}

/// Prints the lines to paste, if any.
std::string lines_of(const Suggestion& one) {
    if (one.lines.empty()) return "  nothing: the predicate as it is\n";
    std::string text;
    for (const std::string& line : one.lines) text += fmt::format("  {}\n", line);
    return text;
}

std::string report(const Suggestions& all) {
    std::string text =
        fmt::format("\n{}\n  AUROC                   elements  distance\n", all.predicate);
    for (const Suggestion& one : all.ranked) text += row(one);
    for (const Suggestion& one : all.ranked)
        if (!one.auroc.value) text += fmt::format("- {}: {}\n", one.distance, one.why_not);
    if (!all.ranked.front().auroc.value) return text;
    text += "\nBest:\n" + lines_of(all.ranked.front());
    if (all.recommended != 0)
        text += "\nRecommended, the cheapest of those marked *:\n" +
                lines_of(all.ranked[all.recommended]);
    return text;
}

std::string number(const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : "null";
}

std::string end_of(const episodes::Figure& figure, double episodes::Interval::*end) {
    return number(figure.interval ? std::optional((*figure.interval).*end) : std::nullopt);
}

std::string json(const Suggestion& one, bool recommended) {
    std::vector<std::string> lines;
    for (const std::string& line : one.lines) lines.push_back(source::json_string(line));
    return fmt::format(
        "{{\"auroc\": {}, \"low\": {}, \"high\": {}, \"ties\": {}, \"recommended\": {}, "
        "\"elements\": {},\n       \"distance\": {},\n       \"lines\": [{}],\n"
        "       \"why_not\": {}}}",
        number(one.auroc.value), end_of(one.auroc, &episodes::Interval::low),
        end_of(one.auroc, &episodes::Interval::high), one.ties, recommended, one.elements,
        source::json_string(one.distance), fmt::join(lines, ",\n                 "),
        one.why_not.empty() ? "null" : source::json_string(one.why_not));
}

std::string json(const Suggestions& all) {
    std::vector<std::string> ranked;
    for (std::size_t i = 0; i < all.ranked.size(); ++i)
        ranked.push_back(
            json(all.ranked[i], i == all.recommended && all.ranked[i].auroc.value.has_value()));
    return fmt::format("{{\"predicate\": {}, \"ranked\": [\n      {}]}}",
                       source::json_string(all.predicate), fmt::join(ranked, ",\n      "));
}

// ---- in time ------------------------------------------------------------------------------------

constexpr std::size_t kShown = 12;  ///< candidates in a table for people

std::string row(const InTime& one, const RankedInTime& all) {
    std::string columns;
    for (std::size_t i = 0; all.of_monitor && i < one.parts.size(); ++i)
        columns += fmt::format("{:>{}}  ", shown(one.parts[i]), titles_of(all)[i].size());
    return fmt::format("{} {:20}  {}{}{}\n", one.ties && !all.of_deadlines ? '*' : ' ',
                       shown(one.score), columns, one.formula,
                       one.lines.empty() ? " (as it is)" : "");
}

/// Returns what is above the columns.
std::string heading_of(const RankedInTime& all) {
    if (!all.of_monitor)
        return fmt::format("\n{}\n  {:20}  formula\n", all.name,
                           all.by == RankedBy::decided ? "decided by frame" : "F1 by frame");
    const auto [first, second] = titles_of(all);
    const char* const score = all.by == RankedBy::outcome   ? "balanced accuracy"
                              : all.by == RankedBy::decided ? "mean of decided"
                                                            : "mean";
    return fmt::format("\nmonitor {}\n  {:20}  {}  {}  {}\n", all.name, score, first, second,
                       all.of_deadlines ? "deadline of a phase" : "in place of a predicate");
}

/// Returns the predicate or monitor as it is, among the candidates.
const InTime& as_it_is(const RankedInTime& all) {
    return *std::find_if(all.ranked.begin(), all.ranked.end(),
                         [](const InTime& one) { return one.lines.empty(); });
}

/// `monitors_gain`: whether some monitor is surely better with a formula than as it is; nothing
/// without monitors.
std::string text_of_ranking(const RankedInTime& all, std::optional<bool> monitors_gain) {
    std::string text = heading_of(all);
    if (all.of_deadlines) {
        for (const InTime& one : all.ranked) text += row(one, all);
        text += '\n';
        for (const InTime& one : all.ranked)
            for (const std::string& line : one.lines) text += fmt::format("  {}\n", line);
        return text;
    }
    const InTime& own = as_it_is(all);
    for (const InTime& one : all.ranked)
        if (&one - all.ranked.data() < static_cast<std::ptrdiff_t>(kShown) || &one == &own)
            text += row(one, all);
    if (all.nested)
        text += fmt::format("  {:20}  the best on the other folds, judged on each in turn\n",
                            shown(all.nested));
    if (all.clock) {
        text += fmt::format("  {:20}  the number of the step alone\n", shown(all.clock));
        const episodes::Figure& best = all.ranked.front().score;
        if (best.value && (best.interval ? best.interval->low : *best.value) <= *all.clock)
            text += "None is surely better than the number of the step.\n";
    }
    if (own.ties)
        return text + fmt::format(
                          "'{}' as it is may be as good as the best: these episodes show "
                          "nothing to gain.\n",
                          all.name);
    const bool only_by_frame = !all.of_monitor && monitors_gain == false;
    text += only_by_frame ? "\nBest by frame, though no monitor is surely better with a formula:\n"
                          : "\nBest:\n";
    for (const std::string& line : all.ranked.front().lines) text += fmt::format("  {}\n", line);
    return text;
}

std::string json_of(const InTime& one, const RankedInTime& all) {
    std::string parts;
    for (std::size_t i = 0; i < one.parts.size(); ++i) {
        std::string key(titles_of(all)[i]);
        std::replace(key.begin(), key.end(), ' ', '_');
        parts += fmt::format("\"{}\": {}, ", key, number(one.parts[i]));
    }
    std::vector<std::string> lines;
    for (const std::string& line : one.lines) lines.push_back(source::json_string(line));
    return fmt::format(
        "{{\"score\": {}, \"low\": {}, \"high\": {}, \"ties\": {}, {}"
        "\n       \"formula\": {},\n       \"lines\": [{}]}}",
        number(one.score.value), end_of(one.score, &episodes::Interval::low),
        end_of(one.score, &episodes::Interval::high), one.ties, parts,
        source::json_string(one.formula), fmt::join(lines, ",\n                 "));
}

std::string report(const SuggestedInTime& suggested) {
    if (!suggested.why_not.empty())
        return fmt::format("\nNothing was tried in time: {}\n", suggested.why_not);
    const auto is_any = [&](const auto& is_such) {
        return std::any_of(suggested.all.begin(), suggested.all.end(), is_such);
    };
    const std::string trained =
        suggested.folds > 0 ? fmt::format(", trained on other episodes ({} folds)", suggested.folds)
                            : "";
    std::string text;
    if (is_any([](const RankedInTime& one) { return !one.of_deadlines; }))
        text = fmt::format(
            "\nIn time{}: formulas beside the truth of\n"
            "a predicate, by F1 over frames; and in its place in monitors, by the mean of the\n"
            "agreements on episodes and on broken variants of them. *: may be as good as the "
            "best.\n",
            trained);
    if (is_any([](const RankedInTime& one) { return one.by == RankedBy::decided; }))
        text +=
            "decided: against both errors, in place of F1 and agreement: the share that is "
            "decided\n"
            "and right, of what is truly satisfied and of what is truly violated, on average.\n";
    if (is_any([](const RankedInTime& one) { return one.by == RankedBy::outcome; }))
        text +=
            "\nbalanced accuracy: the mean of two shares, of successes without an alarm and of "
            "failures\nwith one. Where no episode has an outcome, all count as successes.\n"
            "At most one in ten new successes misses a deadline; each comes from other folds.\n";
    std::optional<bool> monitors_gain;
    for (const RankedInTime& one : suggested.all)
        if (one.of_monitor && !one.of_deadlines)
            monitors_gain = monitors_gain.value_or(false) || !as_it_is(one).ties;
    for (const RankedInTime& one : suggested.all) text += text_of_ranking(one, monitors_gain);
    if (!suggested.why_no_deadlines.empty())
        text += fmt::format("\nNo deadlines were tried: {}\n", suggested.why_no_deadlines);
    return text;
}

std::string json(const SuggestedInTime& suggested) {
    std::vector<std::string> all;
    for (const RankedInTime& one : suggested.all) {
        std::vector<std::string> ranked;
        for (const InTime& candidate : one.ranked) ranked.push_back(json_of(candidate, one));
        all.push_back(
            fmt::format("{{\"{}\": {}, \"by\": \"{}\", \"clock\": {}, \"nested\": {}, "
                        "\"ranked\": [\n      {}]}}",
                        one.of_deadlines ? "deadlines"
                        : one.of_monitor ? "monitor"
                                         : "predicate",
                        source::json_string(one.name),
                        one.by == RankedBy::outcome   ? "outcome"
                        : one.by == RankedBy::decided ? "decided"
                                                      : "truth",
                        number(one.clock), number(one.nested), fmt::join(ranked, ",\n      ")));
    }
    return fmt::format("{{\"folds\": {}, \"why_not\": {}, \"of\": [\n    {}]}}", suggested.folds,
                       suggested.why_not.empty() ? "null" : source::json_string(suggested.why_not),
                       fmt::join(all, ",\n    "));
}

}  // namespace

std::string report(const Suggested& suggested) {
    if (suggested.of.empty()) return report(suggested.in_time);
    std::string text = fmt::format(
        "Tried on {}, {}: the area under the ROC curve by frame, on episodes that were\n"
        "not fitted on ({}), with the 95 % interval over episodes, and the elements that a\n"
        "step compares. *: the interval reaches that of the best. contrast: less the same "
        "distance\n"
        "to the frames at which the predicate does not hold.\n",
        counted(suggested.episodes, "episode"), counted(suggested.frames, "frame"),
        counted(suggested.folds, "fold"));
    for (const Suggestions& one : suggested.of) text += report(one);
    return text + report(suggested.in_time);
}

std::string json(const Suggested& suggested) {
    std::vector<std::string> all;
    for (const Suggestions& one : suggested.of) all.push_back(json(one));
    return fmt::format(
        "{{\n  \"episodes\": {}, \"frames\": {}, \"folds\": {},\n  \"predicates\": [\n    "
        "{}],\n  \"in_time\": {}\n}}\n",
        suggested.episodes, suggested.frames, suggested.folds, fmt::join(all, ",\n    "),
        json(suggested.in_time));
}

}  // namespace etlc::fit
