#include "lsp/format/declaration.hpp"

#include <algorithm>
#include <map>

#include "lsp/format/gap.hpp"

namespace etlc::lsp {

namespace {

using parse::Word;
using Words = std::vector<Word>;

constexpr std::size_t kIndent = 4;

bool is_bracket(const source::File& file, const Word& word) {
    const std::string_view text = file.text(word.span);
    return text == "(" || text == ")";
}

/// Where something stands between two words that are no round brackets: how many of them stand
/// before it, and how many brackets since.
struct Place {
    std::size_t words = 0;
    std::size_t brackets = 0;

    auto operator<=>(const Place&) const = default;
};

/// The place behind each word.
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

/// By the number of words before it, how many brackets follow.
std::map<std::size_t, std::size_t> brackets_behind(const std::vector<Place>& all) {
    std::map<std::size_t, std::size_t> result;
    for (const Place& place : all) result[place.words] = place.brackets;
    return result;
}

/// Puts words behind one another and knows how far the next line is indented.
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

    /// `next`: the word that will follow; empty: a comment.
    void break_line(std::string_view next) {
        while (text_.ends_with(' ')) text_.pop_back();
        if (!open_.empty() && open_.back() == column()) open_.back() = kIndent;  // ends its line
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
    std::vector<std::size_t> open_;  ///< columns behind the brackets that are open
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

/// The gaps of the written words by their places among the canonical ones. Empty: nothing but the
/// canonical text is to be kept.
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
            // Behind what closes, before what opens.
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
    if (from.back().words != to.back().words)  // it has other words: it stays as it is
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

}  // namespace etlc::lsp
