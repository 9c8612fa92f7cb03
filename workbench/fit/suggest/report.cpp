// Prints suggestions as text and as JSON.
#include <fmt/format.h>

#include <algorithm>

#include "fit/suggest/suggest.hpp"
#include "source/text.hpp"

namespace etlc::fit {

namespace {

using diag::counted;

std::string figure(const episodes::Auroc& auroc) {
    if (!auroc.interval) return fmt::format("{:.3f}", auroc.value);
    return fmt::format("{:.3f} [{:.3f}, {:.3f}]", auroc.value, auroc.interval->low,
                       auroc.interval->high);
}

std::string row(const Suggestion& one) {
    return fmt::format("{} {:20}  {:>10}  {}{}\n", one.ties ? '*' : ' ',
                       one.auroc ? figure(*one.auroc) : "-", one.elements, one.distance,
                       one.lines.empty() ? " (as it is)" : "");
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
        if (!one.auroc) text += fmt::format("- {}: {}\n", one.distance, one.why_not);
    if (!all.ranked.front().auroc) return text;
    text += "\nBest:\n" + lines_of(all.ranked.front());
    if (all.recommended != 0)
        text += "\nRecommended, the cheapest of those marked *:\n" +
                lines_of(all.ranked[all.recommended]);
    return text;
}

std::string json(const Suggestion& one, bool recommended) {
    std::vector<std::string> lines;
    for (const std::string& line : one.lines) lines.push_back(source::json_string(line));
    const auto number = [&](double episodes::Auroc::Interval::*end) {
        return one.auroc && one.auroc->interval ? fmt::format("{}", (*one.auroc->interval).*end)
                                                : "null";
    };
    return fmt::format(
        "{{\"auroc\": {}, \"low\": {}, \"high\": {}, \"ties\": {}, \"recommended\": {}, "
        "\"elements\": {},\n       \"distance\": {},\n       \"lines\": [{}],\n"
        "       \"why_not\": {}}}",
        one.auroc ? fmt::format("{}", one.auroc->value) : "null",
        number(&episodes::Auroc::Interval::low), number(&episodes::Auroc::Interval::high), one.ties,
        recommended, one.elements, source::json_string(one.distance),
        fmt::join(lines, ",\n                 "),
        one.why_not.empty() ? "null" : source::json_string(one.why_not));
}

std::string json(const Suggestions& all) {
    std::vector<std::string> ranked;
    for (std::size_t i = 0; i < all.ranked.size(); ++i)
        ranked.push_back(
            json(all.ranked[i], i == all.recommended && all.ranked[i].auroc.has_value()));
    return fmt::format("{{\"predicate\": {}, \"ranked\": [\n      {}]}}",
                       source::json_string(all.predicate), fmt::join(ranked, ",\n      "));
}

}  // namespace

std::string report(const Suggested& suggested) {
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
