#include <fmt/format.h>

#include <algorithm>

#include "check/names/reserved.hpp"
#include "lsp/answers/navigation.hpp"
#include "parse/parse.hpp"
#include "parse/words.hpp"

namespace etlc::lsp {

namespace {

[[noreturn]] void refuse(std::string why) {
    throw Refusal{ErrorCode::request_failed, std::move(why)};
}

const Occurrence& name_at(const Analysis& analysis, std::uint32_t offset) {
    const Occurrence* const at = occurrence_at(analysis.names, offset);
    if (at == nullptr) refuse("no name of this spec stands here");
    if (declaration_of(analysis.names, *at) == nullptr)
        refuse(fmt::format("'{}' is not declared", at->name));
    return *at;
}

unsigned line_of(const Analysis& analysis, source::Span span) {
    return analysis.lines.position(span.begin).line + 1;
}

/// What this spec says about the old name that a rename cannot follow.
void refuse_where_unsure(const Analysis& analysis, const Occurrence& of) {
    const std::string& name = of.name;
    for (const Occurrence& occurrence : analysis.names.occurrences) {
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
    for (const Declared& other : analysis.names.declared)
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

/// Contextual words can be names, but not everywhere: the new text has to be read as the old one.
void refuse_other_meaning(const Analysis& analysis, const std::vector<const Occurrence*>& all,
                          const std::string& new_name) {
    const source::File file(analysis.file.path(), renamed(analysis, all, new_name));
    diag::Sink sink;
    const Names after = names_of(parse::parse(file, sink), file);
    std::vector<Occurrence> before = analysis.names.occurrences;
    std::erase_if(before, [](const Occurrence& occurrence) { return occurrence.uncertain; });
    bool same = after.readable.size() == analysis.names.readable.size() &&
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

}  // namespace

Json edits_of_name(const Analysis& analysis, const Occurrence& of, const std::string& new_name) {
    Json edits = Json::array();
    for (const Occurrence& occurrence : analysis.names.occurrences)
        if (occurrence.means_the_same(of))
            edits.push_back(
                {{"range", json_of(analysis.lines.range(occurrence.span))}, {"newText", new_name}});
    return edits;
}

Json prepare_rename(const Analysis& analysis, std::uint32_t offset) {
    const Occurrence& at = name_at(analysis, offset);
    refuse_where_unsure(analysis, at);
    return {{"range", json_of(analysis.lines.range(at.span))}, {"placeholder", at.name}};
}

Json rename(const Analysis& analysis, std::uint32_t offset, const std::string& new_name,
            const std::string& uri) {
    const Occurrence& of = name_at(analysis, offset);
    if (of.name == new_name) return nullptr;
    refuse_where_unsure(analysis, of);
    refuse_bad_name(analysis, *declaration_of(analysis.names, of), new_name);
    std::vector<const Occurrence*> all;
    for (const Occurrence& occurrence : analysis.names.occurrences)
        if (occurrence.means_the_same(of)) all.push_back(&occurrence);
    refuse_other_meaning(analysis, all, new_name);
    return {{"changes", {{uri, edits_of_name(analysis, of, new_name)}}}};
}

}  // namespace etlc::lsp
