// Answers that change a text.
#include <fmt/format.h>

#include <algorithm>

#include "check/names/reserved.hpp"
#include "lsp/answers/answers.hpp"
#include "lsp/format/format.hpp"
#include "parse/parse.hpp"
#include "parse/stream/words.hpp"

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

/// Returns the edits of all occurrences of a name.
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

Json formatting(const Question& question) {
    const Analysis& analysis = question.analysis();
    const auto after = formatted(analysis.file);
    if (!after) return nullptr;
    const std::string_view before = analysis.file.text();
    if (*after == before) return Json::array();
    std::size_t same = 0;
    while (same < before.size() && same < after->size() && before[same] == (*after)[same]) ++same;
    const std::size_t line = before.rfind('\n', same == 0 ? 0 : same - 1);
    const std::size_t begin = same == 0 || line == std::string_view::npos ? 0 : line + 1;
    std::size_t end = 0;  // bytes from the end
    while (end < before.size() - begin && end < after->size() - begin &&
           before[before.size() - end - 1] == (*after)[after->size() - end - 1])
        ++end;
    // The edit ends after a line end, which may have two bytes.
    const std::size_t tail = before.find('\n', before.size() - end);
    end = tail == std::string_view::npos ? 0 : before.size() - tail - 1;
    const source::Span span{static_cast<std::uint32_t>(begin),
                            static_cast<std::uint32_t>(before.size() - end)};
    return Json::array({{{"range", analysis.lines.range(span)},
                         {"newText", after->substr(begin, after->size() - end - begin)}}});
}

}  // namespace etlc::lsp
