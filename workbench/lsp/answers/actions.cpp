#include "lsp/answers/actions.hpp"

#include <fmt/format.h>

#include "lsp/answers/navigation.hpp"

namespace etlc::lsp {

namespace {

std::string title(const diag::Diagnostic& found, const Analysis& analysis) {
    if (found.span->begin == found.span->end) return fmt::format("Insert '{}'", found.meant);
    return fmt::format("Change '{}' to '{}'", analysis.file.text(*found.span), found.meant);
}

Json edits(const diag::Diagnostic& found, const Analysis& analysis) {
    for (const Occurrence& occurrence : analysis.names.occurrences)
        if (occurrence.declares && occurrence.span == *found.span)
            return edits_of_name(analysis, occurrence, found.meant);
    return Json::array(
        {{{"range", json_of(analysis.lines.range(*found.span))}, {"newText", found.meant}}});
}

}  // namespace

Json code_actions(const Analysis& analysis, source::Span range, const std::string& uri) {
    Json actions = Json::array();
    for (const diag::Diagnostic& found : analysis.sink.sorted()) {
        if (found.meant.empty() || !found.span || !found.file.empty()) continue;
        if (found.span->end < range.begin || range.end < found.span->begin) continue;
        actions.push_back({{"title", title(found, analysis)},
                           {"kind", "quickfix"},
                           {"isPreferred", true},
                           {"edit", {{"changes", {{uri, edits(found, analysis)}}}}}});
    }
    return actions;
}

}  // namespace etlc::lsp
