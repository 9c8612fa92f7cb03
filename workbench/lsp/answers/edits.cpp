// Answers that change a text.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "check/names/reserved.hpp"
#include "lsp/answers/answers.hpp"
#include "lsp/text/json.hpp"
#include "parse/parse.hpp"
#include "parse/stream/words.hpp"
#include "source/text.hpp"

namespace etlc::lsp {

namespace {

[[noreturn]] void refuse(std::string why) {
    throw Refusal{ErrorCode::request_failed, std::move(why)};
}

const Occurrence& name_at(const Analysis& analysis, std::uint32_t offset) {
    const Occurrence* const at = occurrence_at(analysis.names(), offset);
    if (at == nullptr) refuse("no name of this spec stands here");
    if (declaration_of(analysis.names(), *at) == nullptr)
        refuse(fmt::format("'{}' is not declared", at->name));
    return *at;
}

unsigned line_of(const Analysis& analysis, source::Span span) {
    return analysis.lines.position(span.begin).line + 1;
}

/// Refuses a rename where the old name has uses that cannot be renamed.
void refuse_where_unsure(const Analysis& analysis, const Occurrence& of) {
    const std::string& name = of.name;
    for (const Occurrence& occurrence : analysis.names().occurrences) {
        if (!occurrence.means_the_same(of)) continue;
        if (occurrence.uncertain)
            refuse(fmt::format("line {} has '{}' in a declaration that cannot be read",
                               line_of(analysis, occurrence.span), name));
        if (occurrence.quoted)
            refuse(fmt::format("line {} reads '{}' from a recording, which has it by this name",
                               line_of(analysis, occurrence.span), name));
    }
}

void refuse_bad_name(const Analysis& analysis, const Declared& declared,
                     const std::string& new_name) {
    if (!parse::is_name(new_name))
        refuse(fmt::format(
            "'{}' is not a name: names are letters, digits and _, and no reserved words",
            new_name));
    const bool is_spec = !declared.kind;
    if (const auto why = check::why_forbidden(new_name, is_spec))
        refuse(fmt::format("'{}' {}; use another name, for example '{}'", new_name, *why,
                           check::allowed_name(
                               new_name, is_spec ? "spec" : check::word(*declared.kind), is_spec)));
    for (const Declared& other : analysis.names().declared)
        if (!is_spec && other.kind && other.name == new_name)
            refuse(fmt::format("'{}' is declared already, on line {}", new_name,
                               line_of(analysis, other.name_span)));
}

std::string renamed(const Analysis& analysis, const std::vector<const Occurrence*>& all,
                    const std::string& new_name) {
    std::string text;
    std::uint32_t from = 0;
    for (const Occurrence* occurrence : all) {
        text += analysis.file.text({from, occurrence->span.begin});
        text += new_name;
        from = occurrence->span.end;
    }
    text += analysis.file.text({from, static_cast<std::uint32_t>(analysis.file.text().size())});
    return text;
}

/// Refuses a new name that is a word of the language at some place: the renamed text must parse to
/// the same names.
void refuse_other_meaning(const Analysis& analysis, const std::vector<const Occurrence*>& all,
                          const std::string& new_name) {
    const source::File file(analysis.file.path(), renamed(analysis, all, new_name));
    diag::Sink sink;
    const Names after = names_of(parse::parse(file, sink), file);
    std::vector<Occurrence> before = analysis.names().occurrences;
    std::erase_if(before, [](const Occurrence& occurrence) { return occurrence.uncertain; });
    bool same = after.readable.size() == analysis.names().readable.size() &&
                after.occurrences.size() == before.size();
    for (std::size_t i = 0; same && i < before.size(); ++i) {
        const Occurrence& now = after.occurrences[i];
        const bool changed = before[i].means_the_same(*all.front());
        same = now.name == (changed ? new_name : before[i].name) &&
               now.declares == before[i].declares && now.of_spec == before[i].of_spec;
    }
    if (!same)
        refuse(fmt::format("'{}' is a word of the language where '{}' stands", new_name,
                           all.front()->name));
}

Json edits_of_name(const Analysis& analysis, const Occurrence& of, const std::string& new_name) {
    Json edits = Json::array();
    for (const Occurrence& occurrence : analysis.names().occurrences)
        if (occurrence.means_the_same(of))
            edits.push_back(
                {{"range", analysis.lines.range(occurrence.span)}, {"newText", new_name}});
    return edits;
}

std::string title(const diag::Diagnostic& found, const Analysis& analysis) {
    if (found.span->begin == found.span->end) return fmt::format("Insert '{}'", found.meant);
    return fmt::format("Change '{}' to '{}'", analysis.file.text(*found.span), found.meant);
}

Json edits(const diag::Diagnostic& found, const Analysis& analysis) {
    for (const Occurrence& occurrence : analysis.names().occurrences)
        if (occurrence.declares && occurrence.span == *found.span)
            return edits_of_name(analysis, occurrence, found.meant);
    return Json::array({{{"range", analysis.lines.range(*found.span)}, {"newText", found.meant}}});
}

}  // namespace

Json prepare_rename(const Question& question) {
    const Analysis& analysis = question.analysis();
    const Occurrence& at = name_at(analysis, question.offset());
    refuse_where_unsure(analysis, at);
    return {{"range", analysis.lines.range(at.span)}, {"placeholder", at.name}};
}

Json rename(const Question& question) {
    const Analysis& analysis = question.analysis();
    const std::string& new_name = text_of(question.params, "newName");
    const Occurrence& of = name_at(analysis, question.offset());
    if (of.name == new_name) return nullptr;
    refuse_where_unsure(analysis, of);
    refuse_bad_name(analysis, *declaration_of(analysis.names(), of), new_name);
    std::vector<const Occurrence*> all;
    for (const Occurrence& occurrence : analysis.names().occurrences)
        if (occurrence.means_the_same(of)) all.push_back(&occurrence);
    refuse_other_meaning(analysis, all, new_name);
    return {{"changes", {{question.uri(), edits_of_name(analysis, of, new_name)}}}};
}

Json code_actions(const Question& question) {
    const Analysis& analysis = question.analysis();
    const source::Span range = analysis.lines.span(range_of(member(question.params, "range")));
    Json actions = Json::array();
    for (const diag::Diagnostic& found : analysis.sink.sorted()) {
        if (found.meant.empty() || !found.span || !found.file.empty()) continue;
        if (found.span->end < range.begin || range.end < found.span->begin) continue;
        actions.push_back({{"title", title(found, analysis)},
                           {"kind", "quickfix"},
                           {"isPreferred", true},
                           {"edit", {{"changes", {{question.uri(), edits(found, analysis)}}}}}});
    }
    return actions;
}

namespace {

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
                        // The protocol numbers them in the same order, from 1.
                        {"severity", 1 + static_cast<int>(found.severity())},
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
