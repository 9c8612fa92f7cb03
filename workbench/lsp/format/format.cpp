#include "lsp/format/format.hpp"

#include <algorithm>

#include "ast/ast.hpp"
#include "diag/diag.hpp"
#include "lsp/format/declaration.hpp"
#include "lsp/format/gap.hpp"
#include "parse/parse.hpp"
#include "parse/words.hpp"
#include "source/utf8.hpp"

namespace etlc::lsp {

namespace {

using parse::Word;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = text.find('\n', at);
        lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

/// The words of each declaration, up to its semicolon.
std::vector<std::vector<Word>> declarations_of(const source::File& file) {
    std::vector<std::vector<Word>> all(1);
    for (const Word& word : parse::words_of(file)) {
        all.back().push_back(word);
        if (file.text(word.span) == ";") all.emplace_back();
    }
    all.pop_back();  // behind the last semicolon there is none
    return all;
}

std::size_t characters(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    }));
}

/// A declaration, or a comment on lines of its own, with what stands behind it on its line.
struct Line {
    std::string text;
    std::string behind;  ///< comments
    bool after_empty_line = false;
    bool is_comment = false;
};

class Formatter {
public:
    explicit Formatter(const source::File& file) : file_(file) {
        const std::size_t first = file.text().find('\n');
        const bool carriage_return =
            first != std::string_view::npos && first > 0 && file.text()[first - 1] == '\r';
        line_end_ = carriage_return ? "\r\n" : "\n";
    }

    std::string run(const std::vector<std::string>& canonical) {
        const auto declarations = declarations_of(file_);
        const bool has_mark = file_.text().starts_with(source::kByteOrderMark);
        std::uint32_t from = has_mark ? source::kByteOrderMark.size() : 0;
        for (std::size_t i = 0; i < declarations.size(); ++i) {
            const auto& words = declarations[i];
            between(gap_of(file_.text({from, words.front().span.begin})), false);
            Line& line = open_line();
            line.text += formatted_declaration(file_, words, canonical[i], line_end_);
            from = words.back().span.end;
        }
        const auto size = static_cast<std::uint32_t>(file_.text().size());
        between(gap_of(file_.text({from, size})), true);
        return (has_mark ? std::string(source::kByteOrderMark) : "") + joined();
    }

private:
    /// The line that the next declaration goes to: a new one, or one begun by a comment.
    Line& open_line() {
        if (!begun_) lines_.push_back({"", "", empty_line_, false});
        begun_ = false;
        Line& line = lines_.back();
        line.is_comment = false;
        return line;
    }

    void between(const Gap& gap, bool is_last) {
        bool behind = !lines_.empty();  // still on the line of the declaration before
        for (const Comment& comment : gap.comments) {
            const bool same_line = comment.lines_before == 0;
            behind = behind && same_line;
            if (behind)
                add(lines_.back().behind, comment);
            else if (begun_ && same_line)
                add(lines_.back().text, comment);
            else
                lines_.push_back(
                    {comment.text, "", !lines_.empty() && comment.lines_before > 1, true});
            begun_ = !behind;
        }
        // A comment before a declaration on its line stays there.
        begun_ = begun_ && !is_last && gap.lines_after == 0 &&
                 !(gap.comments.empty() || gap.comments.back().to_line_end);
        if (begun_) lines_.back().text += ' ';
        empty_line_ = !lines_.empty() && gap.lines_after > 1;
    }

    static void add(std::string& to, const Comment& comment) {
        if (!to.empty()) to += ' ';
        to += comment.text;
    }

    bool is_single(const Line& line) const {
        return !line.is_comment && line.text.find('\n') == std::string::npos;
    }

    /// Comments behind declarations that stand below one another begin in one column.
    std::size_t width_from(std::size_t first, std::size_t& end) const {
        std::size_t width = 0;
        for (end = first; end < lines_.size() && is_single(lines_[end]); ++end) {
            if (end > first && lines_[end].after_empty_line) break;
            if (!lines_[end].behind.empty()) width = std::max(width, characters(lines_[end].text));
        }
        return width;
    }

    std::string joined() const {
        std::string text;
        std::size_t end = 0;
        std::size_t width = 0;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            if (i >= end) width = width_from(i, end);
            const Line& line = lines_[i];
            if (line.after_empty_line) text += line_end_;
            text += line.text;
            if (!line.behind.empty()) {
                const std::size_t taken = characters(line.text);
                text.append(is_single(line) ? width - taken + 2 : 2, ' ');
                text += line.behind;
            }
            text += line_end_;
        }
        return text;
    }

    const source::File& file_;
    std::string line_end_;
    std::vector<Line> lines_;
    bool begun_ = false;       ///< the last line is a comment that a declaration follows
    bool empty_line_ = false;  ///< one stands before the next declaration
};

}  // namespace

std::optional<std::string> formatted(const source::File& file) {
    diag::Sink sink;
    const ast::Spec spec = parse::parse(file, sink);
    if (sink.has_errors()) return std::nullopt;
    const std::vector<std::string> canonical = lines_of(ast::print(spec));
    if (canonical.size() != declarations_of(file).size()) return std::nullopt;
    return Formatter(file).run(canonical);
}

}  // namespace etlc::lsp
