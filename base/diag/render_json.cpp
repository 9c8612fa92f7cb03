#include <algorithm>
#include <nlohmann/json.hpp>

#include "diag/render.hpp"

namespace etlc::diag {

namespace {

using Json = nlohmann::ordered_json;

/// file, line, column, end_line, end_column; null where unknown. The end is the position just after
/// the span.
void add_place(Json& to, const source::File& spec, const std::optional<source::Span>& span) {
    to["file"] = spec.path();
    for (const char* key : {"line", "column", "end_line", "end_column"}) to[key] = nullptr;
    if (!span) return;
    const source::Position begin = spec.position(span->begin);
    const source::Position end = spec.position(std::max(span->begin, span->end));
    to["line"] = begin.line;
    to["column"] = begin.column;
    to["end_line"] = end.line;
    to["end_column"] = end.column;
}

void add_place(Json& to, const Diagnostic& diagnostic) {
    to["file"] = diagnostic.file;
    for (const char* key : {"line", "column", "end_line", "end_column"}) to[key] = nullptr;
    if (diagnostic.line > 0) to["line"] = diagnostic.line;
    if (diagnostic.line > 0 && diagnostic.column > 0) to["column"] = diagnostic.column;
}

Json note_of(const source::File& spec, const Note& note) {
    Json result;
    result["message"] = note.text;
    add_place(result, spec, note.span);
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
        add_place(result, spec, diagnostic.span);
    else
        add_place(result, diagnostic);
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
