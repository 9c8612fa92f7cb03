#include "lsp/format/format.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "ast/ast.hpp"
#include "diag/diag.hpp"
#include "parse/parse.hpp"
#include "parse/stream/words.hpp"
#include "source/text.hpp"

namespace etlc::lsp {

namespace {

std::size_t end_of_comment(std::string_view text, std::size_t begin, bool to_line_end) {
    if (to_line_end) return std::min(text.size(), text.find_first_of("\r\n", begin));
    const std::size_t end = text.find("*/", begin + 2);
    return end == std::string_view::npos ? text.size() : end + 2;
}

}  // namespace

Gap gap_of(std::string_view between) {
    Gap gap;
    for (std::size_t at = 0; at < between.size();) {
        const char c = between[at];
        const bool line_end = c == '\n' || (c == '\r' && between.substr(at + 1, 1) != "\n");
        if (line_end) ++gap.lines_after;
        if (c != '/') {
            ++at;
            continue;
        }
        const bool to_line_end = between.substr(at + 1, 1) == "/";
        const std::size_t end = end_of_comment(between, at, to_line_end);
        gap.comments.push_back(
            {std::string(between.substr(at, end - at)), gap.lines_after, to_line_end});
        gap.lines_after = 0;
        at = end;
    }
    return gap;
}

void append(Gap& to, Gap more) {
    if (more.comments.empty()) {
        to.lines_after += more.lines_after;
        return;
    }
    more.comments.front().lines_before += to.lines_after;
    std::move(more.comments.begin(), more.comments.end(), std::back_inserter(to.comments));
    to.lines_after = more.lines_after;
}

namespace {

using parse::Word;
using Words = std::vector<Word>;

constexpr std::size_t kIndent = 4;

bool is_bracket(const source::File& file, const Word& word) {
    const std::string_view text = file.text(word.span);
    return text == "(" || text == ")";
}

/// A place between words: the number of words before it other than round brackets, and the number
/// of brackets since the last of them.
struct Place {
    std::size_t words = 0;
    std::size_t brackets = 0;

    auto operator<=>(const Place&) const = default;
};

/// Returns the place after each word.
std::vector<Place> places(const source::File& file, const Words& words) {
    std::vector<Place> result;
    Place at;
    for (const Word& word : words) {
        if (is_bracket(file, word))
            ++at.brackets;
        else
            at = {at.words + 1, 0};
        result.push_back(at);
    }
    return result;
}

/// The number of brackets after so many words.
std::map<std::size_t, std::size_t> brackets_behind(const std::vector<Place>& all) {
    std::map<std::size_t, std::size_t> result;
    for (const Place& place : all) result[place.words] = place.brackets;
    return result;
}

/// Joins words and indents lines.
class Layout {
public:
    explicit Layout(std::string_view line_end) : line_end_(line_end) {}

    void word(std::string_view text) {
        text_ += text;
        if (text == "(" || text == "[") open_.push_back(column());
        if ((text == ")" || text == "]") && !open_.empty()) open_.pop_back();
    }
    void blanks(std::string_view text) { text_ += text; }

    void comment(const Comment& comment) {
        if (!text_.ends_with(' ') && !text_.ends_with('(') && !text_.ends_with('[')) text_ += ' ';
        text_ += comment.text;
    }

    /// `next`: the following word; empty for a comment.
    void break_line(std::string_view next) {
        while (text_.ends_with(' ')) text_.pop_back();
        if (!open_.empty() && open_.back() == column()) open_.back() = kIndent;  // it ends its line
        const bool closes = next == ")" || next == "]";
        std::size_t indent = open_.empty() ? kIndent : open_.back();
        if (closes && indent == kIndent) indent = 0;
        text_ += line_end_;
        text_.append(indent, ' ');
    }

    std::string take() { return std::move(text_); }

private:
    std::size_t column() const {
        const std::size_t line = text_.find_last_of('\n');
        return line == std::string::npos ? text_.size() : text_.size() - line - 1;
    }

    std::string_view line_end_;
    std::string text_;
    std::vector<std::size_t> open_;  ///< columns after the open brackets
};

void put(Layout& layout, const Gap& gap, std::string_view blanks, std::string_view next) {
    for (const Comment& comment : gap.comments) {
        const bool breaks = comment.lines_before > 0;
        if (breaks) layout.break_line({});
        layout.comment(comment);
    }
    const bool must_break = !gap.comments.empty() && gap.comments.back().to_line_end;
    if (gap.lines_after > 0 || must_break) return layout.break_line(next);
    const bool closes = next == ")" || next == "]" || next == "," || next == ";";
    if (gap.comments.empty())
        layout.blanks(blanks);
    else if (!closes)
        layout.blanks(" ");
}

/// Assigns the gaps between written words to places in the canonical text. Empty: the canonical
/// text is the result.
std::map<Place, Gap> moved_gaps(const source::File& file, const Words& written,
                                const std::vector<Place>& from, const std::vector<Place>& to,
                                const source::File& line, const Words& canonical) {
    const auto before = brackets_behind(from);
    const auto after = brackets_behind(to);
    std::map<Place, Gap> result;
    for (std::size_t i = 0; i + 1 < written.size(); ++i) {
        Gap gap = gap_of(file.text({written[i].span.end, written[i + 1].span.begin}));
        if (gap.is_plain()) continue;
        Place place = from[i];
        if (before.at(place.words) != after.at(place.words)) {
            // After closing brackets, before opening ones.
            place.brackets = 0;
            for (std::size_t k = 0; k < to.size(); ++k)
                if (to[k].words == place.words && to[k].brackets > 0 &&
                    line.text(canonical[k].span) == ")")
                    place.brackets = to[k].brackets;
        }
        append(result[place], std::move(gap));
    }
    return result;
}

}  // namespace

std::string formatted_declaration(const source::File& file, const Words& written,
                                  const std::string& canonical, std::string_view line_end) {
    const source::File line("", canonical);
    const Words words = parse::words_of(line);
    const std::vector<Place> from = places(file, written);
    const std::vector<Place> to = places(line, words);
    if (from.back().words != to.back().words)  // other words: leave it unchanged
        return std::string(file.text({written.front().span.begin, written.back().span.end}));
    const std::map<Place, Gap> gaps = moved_gaps(file, written, from, to, line, words);
    if (gaps.empty()) return canonical;
    Layout layout(line_end);
    for (std::size_t i = 0; i < words.size(); ++i) {
        layout.word(line.text(words[i].span));
        if (i + 1 == words.size()) break;
        const std::string_view blanks = line.text({words[i].span.end, words[i + 1].span.begin});
        const auto gap = gaps.find(to[i]);
        if (gap == gaps.end())
            layout.blanks(blanks);
        else
            put(layout, gap->second, blanks, line.text(words[i + 1].span));
    }
    return layout.take();
}

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

/// Returns the words of each declaration, up to its semicolon.
std::vector<std::vector<Word>> declarations_of(const source::File& file) {
    std::vector<std::vector<Word>> all(1);
    for (const Word& word : parse::words_of(file)) {
        all.back().push_back(word);
        if (file.text(word.span) == ";") all.emplace_back();
    }
    all.pop_back();  // nothing follows the last semicolon
    return all;
}

std::size_t characters(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    }));
}

/// Whether the first line outside of comments, which stay as they are, ends with a carriage return.
bool has_carriage_returns(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const std::string_view two = text.substr(at, 2);
        if (text[at] == '\n') return at > 0 && text[at - 1] == '\r';
        if (two == "//" || two == "/*")
            at = end_of_comment(text, at, two == "//");
        else if (text[at] == '"')
            at = std::min(text.size() - 1, text.find_first_of("\"\n", at + 1)) + 1;
        else
            ++at;
    }
    return false;
}

/// A declaration or a separate comment, with the comments that follow on its line.
struct Line {
    std::string text;
    std::string behind;  ///< comments
    bool after_empty_line = false;
    bool is_comment = false;
};

class Formatter {
public:
    explicit Formatter(const source::File& file)
        : file_(file), line_end_(has_carriage_returns(file.text()) ? "\r\n" : "\n") {}

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
    /// Returns the line of the next declaration: a new one, or one that starts with a comment.
    Line& open_line() {
        if (!begun_) lines_.push_back({"", "", empty_line_, false});
        begun_ = false;
        Line& line = lines_.back();
        line.is_comment = false;
        return line;
    }

    void between(const Gap& gap, bool is_last) {
        bool behind = !lines_.empty();  // on the line of the previous declaration
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

    /// Aligns comments after declarations on successive lines.
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
    bool begun_ = false;       ///< the last line is a comment before a declaration
    bool empty_line_ = false;  ///< an empty line precedes the next declaration
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
