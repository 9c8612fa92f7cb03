#include "lsp/answers/answers.hpp"

#include <algorithm>

#include "lsp/answers/words.hpp"
#include "parse/words.hpp"
#include "source/text.hpp"

namespace etlc::lsp {

namespace {

/// Returns the text of a declaration, or the beginning of a long one, such as a matrix.
std::string written(const Analysis& analysis, const Declared& declared) {
    constexpr std::size_t kLongest = 400;
    std::string text(analysis.file.text(declared.span));
    const bool whole = text.ends_with(';') || declared.kind == check::NameKind::unreadable;
    if (text.size() <= kLongest) return text + (whole ? "" : ";");
    std::size_t end = kLongest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
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

/// The content of a hover: code and sentences.
struct Explained {
    std::string code;
    std::vector<std::string> sentences;
};

Json markup_of(const Explained& explained, bool with_markdown) {
    std::string text = with_markdown ? "```etl\n" + explained.code + "\n```" : explained.code;
    for (const std::string& sentence : explained.sentences)
        text += (with_markdown ? "\n\n" + escaped(sentence) : "\n" + source::visible(sentence));
    return {{"kind", with_markdown ? "markdown" : "plaintext"}, {"value", std::move(text)}};
}

Json found(const Explained& explained, Range range, bool with_markdown) {
    return {{"contents", markup_of(explained, with_markdown)}, {"range", range}};
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
        return found({written(analysis, *declared), facts}, analysis.lines.range(at->span),
                     with_markdown);
    }
    for (const parse::Word& word : parse::words_of(analysis.file)) {
        if (word.span.end < offset) continue;
        if (word.span.begin > offset) break;
        const WordInfo* const info = find_word(analysis.file.text(word.span));
        if (info == nullptr) continue;
        return found({std::string(info->form), {std::string(info->meaning) + "."}},
                     analysis.lines.range(word.span), with_markdown);
    }
    return nullptr;
}

}  // namespace etlc::lsp
