#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "diag/render.hpp"

namespace etlc::diag {

namespace {

using Json = nlohmann::ordered_json;

/// Line, column, end_line and end_column; 0 where unknown. The end is just after the span.
using Place = std::array<std::uint32_t, 4>;

Place place_of(const source::File& spec, const std::optional<source::Span>& span) {
    if (!span) return {};
    const source::Position begin = spec.position(span->begin);
    const source::Position end = spec.position(std::max(span->begin, span->end));
    return {begin.line, begin.column, end.line, end.column};
}

void add_place(Json& to, const std::string& file, const Place& place) {
    constexpr std::array kKeys{"line", "column", "end_line", "end_column"};
    to["file"] = file;
    for (std::size_t i = 0; i < kKeys.size(); ++i)
        to[kKeys[i]] = place[i] > 0 ? Json(place[i]) : Json();
}

Json note_of(const source::File& spec, const Note& note) {
    Json result;
    result["message"] = note.text;
    add_place(result, spec.path(), place_of(spec, note.span));
    return result;
}

Json diagnostic_of(const source::File& spec, const Diagnostic& diagnostic, Severity severity) {
    Json result;
    result["code"] = info(diagnostic.code).code;
    result["name"] = info(diagnostic.code).name;
    result["severity"] = word(severity);
    result["message"] = diagnostic.message;
    const bool in_spec = diagnostic.file.empty();
    if (in_spec)
        add_place(result, spec.path(), place_of(spec, diagnostic.span));
    else
        add_place(result, diagnostic.file,
                  {diagnostic.line, diagnostic.line > 0 ? diagnostic.column : 0});
    result["notes"] = Json::array();
    if (!in_spec && diagnostic.span)
        result["notes"].push_back(note_of(spec, {diagnostic.span, "named here"}));
    for (const Note& n : diagnostic.notes) result["notes"].push_back(note_of(spec, n));
    return result;
}

}  // namespace

std::string render_json(const source::File& spec, const Sink& sink) {
    Json all = Json::array();
    for (const Diagnostic& diagnostic : sink.sorted())
        all.push_back(diagnostic_of(spec, diagnostic, sink.severity(diagnostic)));
    Json document;
    document["diagnostics"] = std::move(all);
    // Paths and quoted words may hold any bytes; those that are not UTF-8 become U+FFFD.
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace etlc::diag
