#include <filesystem>

#include "lsp/answers/answers.hpp"
#include "lsp/text/json.hpp"
#include "parse/stream/words.hpp"
#include "source/text.hpp"

namespace etlc::lsp {

namespace {

Json location(const std::string& uri, Range range) {
    return {{"uri", uri}, {"range", range}};
}

/// Returns the protocol's number of a kind of symbol.
int symbol_kind(const Declared& declared) {
    constexpr int kNamespace = 3;
    constexpr int kField = 8;
    constexpr int kFunction = 12;
    constexpr int kVariable = 13;
    constexpr int kConstant = 14;
    constexpr int kBoolean = 17;
    constexpr int kArray = 18;
    constexpr int kEvent = 24;
    if (!declared.kind) return kNamespace;
    switch (*declared.kind) {
        case check::NameKind::constant: return kConstant;
        case check::NameKind::encoder:
        case check::NameKind::projection: return kFunction;
        case check::NameKind::input: return kField;
        case check::NameKind::target: return kArray;
        case check::NameKind::predicate: return kBoolean;
        case check::NameKind::drift:
        case check::NameKind::monitor: return kEvent;
        case check::NameKind::let:
        case check::NameKind::unreadable: break;
    }
    return kVariable;
}

}  // namespace

Json definition(const Question& question) {
    const Analysis& analysis = question.analysis();
    const std::uint32_t offset = question.offset();
    if (const Occurrence* const at = occurrence_at(analysis.names(), offset)) {
        const Declared* const declared = declaration_of(analysis.names(), *at);
        if (declared == nullptr) return nullptr;
        return location(question.uri(), analysis.lines.range(declared->name_span));
    }
    for (const NamedFile& named : analysis.names().files) {
        if (offset < named.span.begin || offset > named.span.end) continue;
        const std::filesystem::path path =
            std::filesystem::path(analysis.file.path()).parent_path() / named.path;
        std::error_code error;
        if (!std::filesystem::is_regular_file(path, error)) return nullptr;
        return location(uri_of_path(path.string()), {});
    }
    return nullptr;
}

Json references(const Question& question) {
    const Analysis& analysis = question.analysis();
    const Json* const asked = find_path(question.params, "context/includeDeclaration");
    const bool with_declaration = asked == nullptr || *asked == true;
    const Occurrence* const at = occurrence_at(analysis.names(), question.offset());
    if (at == nullptr) return nullptr;
    Json all = Json::array();
    for (const Occurrence& occurrence : analysis.names().occurrences)
        if (occurrence.means_the_same(*at) && (with_declaration || !occurrence.declares))
            all.push_back(location(question.uri(), analysis.lines.range(occurrence.span)));
    return all;
}

Json highlights(const Question& question) {
    const Analysis& analysis = question.analysis();
    const Occurrence* const at = occurrence_at(analysis.names(), question.offset());
    if (at == nullptr) return nullptr;
    constexpr int kRead = 2;
    constexpr int kWrite = 3;
    Json all = Json::array();
    for (const Occurrence& occurrence : analysis.names().occurrences)
        if (occurrence.means_the_same(*at))
            all.push_back({{"range", analysis.lines.range(occurrence.span)},
                           {"kind", occurrence.declares ? kWrite : kRead}});
    return all;
}

Json symbols(const Question& question) {
    const Analysis& analysis = question.analysis();
    Json all = Json::array();
    for (const Declared& declared : analysis.names().declared) {
        Json symbol{{"name", declared.name}, {"kind", symbol_kind(declared)}};
        const Range whole = analysis.lines.range(declared.span);
        if (question.client.hierarchical_symbols) {
            symbol["detail"] = declared.kind ? check::word(*declared.kind) : "spec";
            symbol["range"] = whole;
            symbol["selectionRange"] = analysis.lines.range(declared.name_span);
        } else {
            symbol["location"] = location(question.uri(), whole);
        }
        all.push_back(std::move(symbol));
    }
    return all;
}

namespace {

/// Returns the text of a declaration, or the beginning of a long one, such as a matrix.
std::string written(const Analysis& analysis, const Declared& declared) {
    constexpr std::size_t kLongest = 400;
    std::string text(analysis.file.text(declared.span));
    const bool whole = text.ends_with(';') || declared.kind == check::NameKind::unreadable;
    if (text.size() <= kLongest) return text + (whole ? "" : ";");
    std::size_t end = kLongest;
    while (end > 0 && source::is_continuation(text[end])) --end;
    return text.substr(0, end) + " ...";
}

/// Escapes the marks of Markdown in sentences, which contain names of files and formulas.
std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : source::visible(text)) {
        if (std::string_view("\\`*_{}[]<>#|&!~").find(c) != std::string_view::npos) result += '\\';
        result += c;
    }
    return result;
}

Json found(const std::string& code, const std::vector<std::string>& sentences, Range range,
           bool with_markdown) {
    std::string text = with_markdown ? "```etl\n" + code + "\n```" : code;
    for (const std::string& sentence : sentences)
        text += (with_markdown ? "\n\n" + escaped(sentence) : "\n" + source::visible(sentence));
    return {{"contents",
             {{"kind", with_markdown ? "markdown" : "plaintext"}, {"value", std::move(text)}}},
            {"range", range}};
}

}  // namespace

Json hover(const Question& question) {
    Document& document = question.document;
    const Analysis& analysis = document.analysis();
    const std::uint32_t offset = question.offset();
    const bool with_markdown = question.client.hover_in_markdown;
    if (const Occurrence* const at = occurrence_at(analysis.names(), offset)) {
        const Declared* const declared = declaration_of(analysis.names(), *at);
        if (declared == nullptr) return nullptr;
        const bool has_budget = declared->kind == check::NameKind::monitor;
        if (has_budget && document.needs_plan()) document.plan();
        const std::vector<std::string> facts =
            declared->kind ? facts_of(analysis, at->name, document.planned())
                           : std::vector<std::string>{};
        return found(written(analysis, *declared), facts, analysis.lines.range(at->span),
                     with_markdown);
    }
    for (const parse::Word& word : parse::words_of(analysis.file)) {
        if (word.span.end < offset) continue;
        if (word.span.begin > offset) break;
        const WordInfo* const info = find_word(analysis.file.text(word.span));
        if (info == nullptr) continue;
        return found(std::string(info->form), {std::string(info->meaning) + "."},
                     analysis.lines.range(word.span), with_markdown);
    }
    return nullptr;
}

}  // namespace etlc::lsp
