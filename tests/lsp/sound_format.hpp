// Checks formatting, for tests and for the fuzzer.
// Takes: a text. Gives: the defects of its formatted form; "" if there are none, or if the text
// cannot be read and so is not formatted.
#pragma once

#include <string>
#include <vector>

#include "ast/ast.hpp"
#include "diag/diag.hpp"
#include "lsp/format/format.hpp"
#include "parse/parse.hpp"
#include "parse/stream/words.hpp"

namespace etlc::lsp {

/// Returns each comment with the number of words before it, without round brackets.
inline std::vector<std::string> comments_of(const source::File& file) {
    std::vector<std::string> all;
    std::uint32_t from = file.text().starts_with("\xEF\xBB\xBF") ? 3 : 0;
    std::size_t words = 0;
    const auto take = [&](std::uint32_t to) {
        for (const Comment& comment : gap_of(file.text({from, to})).comments)
            all.push_back(std::to_string(words) + comment.text);
    };
    for (const parse::Word& word : parse::words_of(file)) {
        take(word.span.begin);
        const std::string_view text = file.text(word.span);
        words += text != "(" && text != ")" ? 1 : 0;
        from = word.span.end;
    }
    take(static_cast<std::uint32_t>(file.text().size()));
    return all;
}

inline std::string mistake_in_format(const std::string& text) {
    const source::File before("", text);
    diag::Sink sink;
    const ast::Spec spec = parse::parse(before, sink);
    const auto once = formatted(before);
    if (sink.has_errors()) return once ? "an unreadable text is formatted" : "";
    if (!once) return "a readable text is not formatted";
    if (once->size() > parse::kMaxSpecBytes) return "";
    const source::File after("", *once);
    diag::Sink nothing;
    const ast::Spec again = parse::parse(after, nothing);
    if (nothing.has_errors()) return "the formatted text cannot be read:\n" + *once;
    if (ast::print(again) != ast::print(spec)) return "it reads as another spec:\n" + *once;
    if (comments_of(after) != comments_of(before)) return "comments are lost or moved:\n" + *once;
    const auto twice = formatted(after);
    if (!twice || *twice != *once)
        return "formatting again changes:\n" + *once + "\nto:\n" + twice.value_or("nothing");
    return "";
}

}  // namespace etlc::lsp
