#include "lsp/answers/answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "lsp/text/json.hpp"
#include "source/text.hpp"

namespace etlc::lsp {

namespace {

int number_of(diag::Severity severity) {
    switch (severity) {
        case diag::Severity::error: return 1;
        case diag::Severity::warning: return 2;
        case diag::Severity::note: break;
    }
    return 3;  // information
}

/// Returns a path relative to the folder of the spec.
std::string shown_path(const std::string& path, const source::File& spec) {
    const std::filesystem::path folder = std::filesystem::path(spec.path()).parent_path();
    return source::visible(std::filesystem::path(path).lexically_proximate(folder).string());
}

/// Makes the paths in a message relative to the folder of the spec, as the spec names them.
std::string without_folder(std::string message, const source::File& spec) {
    const std::string folder = std::filesystem::path(spec.path()).parent_path().string() + "/";
    if (folder.size() == 1) return message;
    for (std::size_t at = message.find(folder); at != std::string::npos;
         at = message.find(folder, at))
        message.erase(at, folder.size());
    return message;
}

std::string message_of(const diag::Diagnostic& found, const Analysis& analysis, bool with_related) {
    std::string message = found.message;
    if (!found.file.empty()) {
        const std::string line = found.line > 0 ? fmt::format(":{}", found.line) : "";
        const std::string column =
            found.line > 0 && found.column > 0 ? fmt::format(":{}", found.column) : "";
        message =
            fmt::format("{}{}{}: {}", shown_path(found.file, analysis.file), line, column, message);
    }
    for (const diag::Note& note : found.notes) {
        if (!note.span)
            message += "\n" + note.text;
        else if (!with_related)
            message += fmt::format("\nline {}: {}",
                                   analysis.lines.position(note.span->begin).line + 1, note.text);
    }
    return without_folder(std::move(message), analysis.file);
}

Json related_to(const diag::Diagnostic& found, const Analysis& analysis, const std::string& uri) {
    Json related = Json::array();
    if (!found.file.empty()) {
        const Position at{std::max(found.line, 1U) - 1, std::max(found.column, 1U) - 1};
        related.push_back(
            {{"location", {{"uri", uri_of_path(found.file)}, {"range", Range{at, at}}}},
             {"message", "found in this file"}});
    }
    for (const diag::Note& note : found.notes)
        if (note.span)
            related.push_back(
                {{"location", {{"uri", uri}, {"range", analysis.lines.range(*note.span)}}},
                 {"message", note.text}});
    return related;
}

/// Returns the place at which a finding is shown.
source::Span place_of(const diag::Diagnostic& found, const Analysis& analysis) {
    if (found.span) return *found.span;
    for (const diag::Note& note : found.notes)
        if (!found.file.empty() && note.span) return *note.span;
    return analysis.spec.name.text.empty() ? source::Span{0, 0} : analysis.spec.name.span;
}

}  // namespace

Json diagnostics_of(const Analysis& analysis, const Planned* planned, const std::string& uri,
                    const Client& client) {
    const bool with_related = client.related_places;
    diag::Sink all;
    all.add(analysis.sink, "");
    if (planned != nullptr) all.add(planned->sink, "");
    std::vector<diag::Diagnostic> sorted = all.sorted();
    std::stable_sort(sorted.begin(), sorted.end(), [&](const auto& a, const auto& b) {
        return place_of(a, analysis).begin < place_of(b, analysis).begin;
    });
    Json result = Json::array();
    for (const diag::Diagnostic& found : sorted) {
        Json diagnostic{{"range", analysis.lines.range(place_of(found, analysis))},
                        {"severity", number_of(found.severity())},
                        {"code", diag::info(found.code).code},
                        {"source", "etlc"},
                        {"message", message_of(found, analysis, with_related)}};
        if (with_related) {
            Json related = related_to(found, analysis, uri);
            if (!related.empty()) diagnostic["relatedInformation"] = std::move(related);
        }
        result.push_back(std::move(diagnostic));
    }
    return result;
}

}  // namespace etlc::lsp
