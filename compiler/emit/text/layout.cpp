#include "emit/text/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "plan/program/value_type.hpp"

namespace etlc::emit {

namespace {

using Lines = std::vector<std::string>;
using Text = std::string_view;

constexpr std::size_t kContinued = 4;  ///< indentation of the lines after the first
constexpr std::size_t kLongestQuote = 160;

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Returns whether the text ends in a number: "[0, 8", "x > 0.5".
bool ends_in_number(Text text) {
    std::size_t begin = text.size();
    while (begin > 0 && (is_word(text[begin - 1]) || text[begin - 1] == '.')) --begin;
    const Text word = text.substr(begin);
    return !word.empty() && word.back() != '.' &&
           std::isdigit(static_cast<unsigned char>(word.front())) != 0;
}

bool begins_with_unit(Text text) {
    std::size_t end = 0;
    while (end < text.size() && is_word(text[end])) ++end;
    for (const Text unit : {"us", "ms", "s", "min", "h", "Hz", "step", "steps", "bytes"})
        if (text.substr(0, end) == unit) return true;
    return text.starts_with('%');
}

/// Returns the length of "[0, 8 s]" at the beginning of a text; 0 for a longer list.
std::size_t interval(Text text) {
    constexpr std::size_t kLongestInterval = 32;
    const std::size_t close = text.find(']');
    return close < kLongestInterval && text.find('[', 1) > close ? close + 1 : 0;
}

/// Returns the length of the first words of a text between which no line may break.
std::size_t unbroken(Text text) {
    std::size_t end = 0;
    while (end < text.size()) {
        const std::size_t whole = text[end] == '[' ? interval(text.substr(end)) : 0;
        const bool breaks = text[end] == ' ' && !(ends_in_number(text.substr(0, end)) &&
                                                  begins_with_unit(text.substr(end + 1)));
        if (breaks) break;
        end += std::max<std::size_t>(whole, 1);
    }
    return end;
}

/// Returns the number of open brackets around each character; a bracket itself is outside. `<` is a
/// bracket directly after a name.
std::vector<std::size_t> depths(Text text) {
    std::vector<std::size_t> result;
    std::string open;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool angle = c == '<' && i > 0 && is_word(text[i - 1]);
        const bool closes = c == ')' || c == ']' || c == '}' || (c == '>' && open.ends_with('<'));
        if (closes && !open.empty()) open.pop_back();
        result.push_back(open.size());
        if (c == '(' || c == '[' || c == '{' || angle) open.push_back(c);
    }
    return result;
}

/// Cuts the text before each of these positions, and drops blanks at the cuts.
Lines pieces(Text text, const std::vector<std::size_t>& cuts) {
    Lines result;
    std::size_t begin = 0;
    for (std::size_t end : cuts) {
        std::string piece(text.substr(begin, end - begin));
        piece.erase(piece.find_last_not_of(' ') + 1);
        result.push_back(piece);
        begin = text.find_first_not_of(' ', end);
    }
    result.emplace_back(text.substr(begin));
    return result;
}

/// Finds `what` inside `depth` brackets; with `behind`, the positions after it.
std::vector<std::size_t> places(Text text, Text what, std::size_t depth, bool behind) {
    const std::vector<std::size_t> depth_at = depths(text);
    std::vector<std::size_t> result;
    for (std::size_t i = text.find(what); i != Text::npos; i = text.find(what, i + 1))
        if (depth_at[i] == depth) result.push_back(behind ? i + what.size() : i);
    return result;
}

Lines broken(Text text, std::size_t width);

void append_indented(Lines& lines, const Lines& more, std::size_t indent) {
    for (const std::string& line : more) lines.push_back(std::string(indent, ' ') + line);
}

/// Appends pieces, as many on a line as fit; on the last of `lines` only if `joins`.
void fill(Lines& lines, const Lines& more, std::size_t width, std::size_t indent, bool joins) {
    for (const std::string& piece : more) {
        if (joins && lines.back().size() + 1 + piece.size() <= width) {
            lines.back() += " " + piece;
            continue;
        }
        const Lines own = broken(piece, width - indent);
        append_indented(lines, own, indent);
        joins = own.size() == 1;  // nothing is appended to a piece of several lines
    }
}

/// Breaks `a = c ? x : y` into three lines, and fills lines with `a || b`. Returns nothing for
/// other text.
Lines broken_at_operators(Text text, std::size_t width) {
    const std::size_t depth = text.starts_with("if (") ? 1 : 0;
    std::vector<std::size_t> cuts = places(text, " ? ", depth, false);
    const bool choice = !cuts.empty();
    for (Text sign : {" : ", " && ", " || "}) {
        if (choice != (sign == " : ")) continue;
        const std::vector<std::size_t> more = places(text, sign, depth, !choice);
        cuts.insert(cuts.end(), more.begin(), more.end());
    }
    if (cuts.empty()) return {};
    std::sort(cuts.begin(), cuts.end());
    const Lines parts = pieces(text, cuts);
    Lines lines = broken(parts[0], width);
    if (!choice) {
        fill(lines, Lines(parts.begin() + 1, parts.end()), width, kContinued, lines.size() == 1);
        return lines;
    }
    for (std::size_t i = 1; i < parts.size(); ++i)
        fill(lines, {parts[i]}, width, kContinued, false);
    return lines;
}

/// Breaks `f(a, b)` after its outermost last bracket and between its items. A list `= {a, b};` ends
/// on a separate line.
Lines broken_in_brackets(Text text, std::size_t width) {
    const std::vector<std::size_t> depth_at = depths(text);
    std::size_t close = text.size() - 1;
    while (close > 0 && (depth_at[close] != 0 || depth_at[close - 1] == 0)) --close;
    if (close == 0) return {};
    std::size_t open = close - 1;
    while (depth_at[open] != 0) --open;
    const Text head = text.substr(0, open + 1);
    const Text inside = text.substr(open + 1, close - open - 1);
    const bool list = head.ends_with("= {");
    Lines items = pieces(inside, places(inside, ", ", 0, true));
    if (!list) items.back() += text.substr(close);
    Lines lines = broken(head, width);
    fill(lines, items, width, list ? 2 : kContinued, false);
    if (list) lines.emplace_back(text.substr(close));
    return lines;
}

/// Breaks `a = b` before b. Returns nothing for other text.
Lines broken_at_assignment(Text text, std::size_t width, bool only_if_it_fits) {
    const std::vector<std::size_t> cuts = places(text, " = ", 0, true);
    if (cuts.empty()) return {};
    const Lines parts = pieces(text, {cuts.front()});
    if (only_if_it_fits && (parts[1].size() + kContinued > width || parts[1].starts_with('{')))
        return {};
    Lines lines{parts[0]};
    fill(lines, {parts[1]}, width, kContinued, false);
    return lines;
}

/// Breaks `f() noexcept { return e; }` into a block. Returns nothing for other text.
Lines broken_function(Text text, std::size_t width) {
    const std::size_t begin = text.find(" { ", std::min(text.size(), text.find(" noexcept")));
    if (begin == Text::npos) return {};
    const std::size_t body = begin + 3;
    const std::size_t end = text.rfind(" }");
    Lines lines{std::string(text.substr(0, body - 1))};
    append_indented(lines, broken(text.substr(body, end - body), width - 2), 2);
    lines.emplace_back(text.substr(end + 1));
    return lines;
}

/// Breaks the text into lines of at most `width`, where it can be broken.
Lines broken(Text text, std::size_t width) {
    if (text.size() <= width) return {std::string(text)};
    Lines lines = broken_function(text, width);
    if (lines.empty()) lines = broken_at_operators(text, width);
    if (lines.empty()) lines = broken_at_assignment(text, width, true);
    if (lines.empty()) lines = broken_in_brackets(text, width);
    if (lines.empty()) lines = broken_at_assignment(text, width, false);
    if (lines.empty()) lines = {std::string(text)};
    return lines;
}

}  // namespace

std::string float_literal(float x) {
    if (std::isinf(x))
        return x < 0 ? "etlmon::float_of(etlmon::kBottom)" : "etlmon::float_of(etlmon::kTop)";
    std::string text = fmt::format("{}", x);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text + "f";
}

std::size_t fitting(std::string_view text, std::size_t width) {
    std::size_t end = unbroken(text);
    for (std::size_t next = end; next <= width && next < text.size();
         next += 1 + unbroken(text.substr(next + 1)))
        end = next;
    return end;
}

std::string quoted(std::string_view text) {
    std::string line;
    for (char c : text) {
        const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
        if (!blank)
            line += c;
        else if (!line.empty() && line.back() != ' ')
            line += ' ';
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    if (line.size() <= kLongestQuote) return line;
    std::size_t cut = std::min(fitting(line, kLongestQuote - 4), kLongestQuote - 4);
    while (cut > 0 && (static_cast<unsigned char>(line[cut]) & 0xC0U) == 0x80U)
        --cut;  // not inside a code point
    return line.substr(0, cut) + " ...";
}

void print_wrapped(Printer& out, const std::string& text) {
    if (text.starts_with("if (") && !text.ends_with('{')) {
        const std::vector<std::size_t> depth_at = depths(text);
        std::size_t close = 4;
        while (depth_at[close] != 0) ++close;
        print_wrapped(out, text.substr(0, close + 1) + " {");
        out.indent();
        print_wrapped(out, text.substr(close + 2));
        return out.close();
    }
    for (const std::string& line : broken(text, kLineWidth - out.column())) out.line(line);
}

void print_with_comment(Printer& out, const std::string& text, const std::string& comment) {
    const bool one_line = out.column() + text.size() + 5 + comment.size() <= kLineWidth;
    if (!comment.empty() && one_line && !text.starts_with("if ("))
        return out.line("{}  // {}", text, comment);
    if (!comment.empty()) print_comment(out, "//", comment, 4);
    print_wrapped(out, text);
}

void print_comment(Printer& out, std::string_view mark, std::string_view text, std::size_t hang) {
    std::string line(mark);
    const std::size_t width = kLineWidth - out.column();
    const bool breaks = line.size() + 1 + text.size() > width;
    bool first_word = true;
    while (!text.empty()) {
        const std::string_view word = text.substr(0, unbroken(text));
        // A line that is too long breaks before two blanks first.
        const bool parts = word.empty() && breaks;
        if (!first_word && (parts || line.size() + 1 + word.size() > width)) {
            out.line(line);
            line = std::string(mark) + std::string(hang, ' ');
        }
        text.remove_prefix(std::min(text.size(), word.size() + 1));
        if (!parts) line.append(1, ' ').append(word);
        first_word = false;
    }
    out.line(line);
}

void print_doc(Printer& out, std::string_view text) {
    print_comment(out, "///", text);
}

void print_aligned(Printer& out,
                   const std::vector<std::pair<std::string, std::string>>& declarations,
                   std::string_view mark) {
    constexpr std::size_t kWidest = 56;  // longer ones push their own comment out
    const std::size_t room = kLineWidth - out.column();
    const auto fits = [&](const std::string& declaration, const std::string& comment,
                          std::size_t width) {
        return std::max(declaration.size(), width) + mark.size() + 3 + comment.size() <= room;
    };
    std::size_t width = 0;
    for (const std::size_t widest : {kWidest, room}) {
        if (width > 0) break;
        for (const auto& [declaration, comment] : declarations)
            if (!comment.empty() && declaration.size() <= widest && fits(declaration, comment, 0))
                width = std::max(width, declaration.size());
    }
    for (const auto& [declaration, comment] : declarations) {
        if (comment.empty()) {
            print_wrapped(out, declaration);
        } else if (fits(declaration, comment, width)) {
            out.line("{:<{}}  {} {}", declaration, width, mark, comment);
        } else {
            print_comment(out, mark.substr(0, mark.find('<')), comment, 4);
            print_wrapped(out, declaration);
        }
    }
}

std::string counted(std::string_view counter) {
    return fmt::format("if ({0} != UINT32_MAX) ++{0};", counter);
}

std::set<std::string> function_names(const plan::Plan& plan) {
    const check::Model& model = *plan.model;
    std::set<std::string> names{"max_of", "min_of"};
    for (check::Index p : plan.predicates)
        for (const char* prefix : {"distance_", "nearest_", "threshold_", "unseen_",
                                   "initial_threshold_", "set_threshold_", "observe_"})
            names.insert(prefix + model.predicates[p].name);
    if (plan::value_type(plan.values).sourced)
        for (const plan::Monitor& monitor : plan.monitors) names.insert("why_" + monitor.name);
    for (const plan::Monitor& monitor : plan.monitors)
        for (const char* prefix : {"restart_", "alarms_", "fulfilled_"})
            if (monitor.restarts != check::Restarts::never) names.insert(prefix + monitor.name);
    for (check::Index p : plan.predicates)
        for (check::Index d : check::measured_targets(model, model.predicates[p]))
            names.insert(fmt::format("nearest_{}_{}", model.predicates[p].name,
                                     model.targets[model.distances[d].target].name));
    for (const plan::Let& let : plan.lets)
        for (const char* prefix : {"let_", "robustness_"})
            names.insert(prefix + model.lets[let.index].name);
    return names;
}

std::string shortened(const std::string& formula) {
    constexpr std::size_t kLongest = 60;
    if (formula.size() <= kLongest) return formula;
    return formula.substr(0, std::min(fitting(formula, kLongest - 4), kLongest - 4)) + " ...";
}

std::string number(std::uint64_t x) {
    return fmt::format("{}", x);
}

bool is_comment(const std::string& prefix) {
    return prefix.starts_with("//");
}

namespace {

/// Breaks the words of a cell into lines of at most `width`, unless a word is longer.
std::vector<std::string> lines_of(std::string_view cell, std::size_t width) {
    std::vector<std::string> lines;
    while (cell.size() > width) {
        const std::size_t end = fitting(cell, width);
        if (end == cell.size()) break;
        lines.emplace_back(cell.substr(0, end));
        cell.remove_prefix(end + 1);
    }
    lines.emplace_back(cell);
    return lines;
}

/// Returns the width of each column: of its widest cell. In a comment, words that do not fit
/// continue below.
std::vector<std::size_t> column_widths(const std::string& prefix, const std::vector<Row>& rows,
                                       std::size_t first_number) {
    constexpr std::size_t kWidestText = 40;
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const Row& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    if (!is_comment(prefix)) return widths;
    std::size_t before = prefix.size();
    for (std::size_t c = 0; c < widths.size() && c < first_number; ++c) {
        const bool last = c + 1 == widths.size();
        widths[c] = std::min(widths[c], last ? kLineWidth - before : kWidestText);
        before += widths[c] + 2;
    }
    return widths;
}

}  // namespace

void print_table(Printer& out, const std::string& prefix, const std::vector<Row>& rows,
                 std::size_t first_number) {
    const std::vector<std::size_t> widths = column_widths(prefix, rows, first_number);
    for (const Row& row : rows) {
        std::vector<std::vector<std::string>> cells;
        std::size_t height = 1;
        for (std::size_t c = 0; c < row.size(); ++c) {
            cells.push_back(lines_of(row[c], widths[c]));
            height = std::max(height, cells.back().size());
        }
        for (std::size_t i = 0; i < height; ++i) {
            std::string line = prefix;
            for (std::size_t c = 0; c < row.size(); ++c) {
                const std::string text = i < cells[c].size() ? cells[c][i] : "";
                line += c < first_number ? fmt::format("{:<{}}  ", text, widths[c])
                                         : fmt::format("{:>{}}  ", text, widths[c]);
            }
            line.erase(line.find_last_not_of(' ') + 1);
            out.line(line);
        }
    }
}

}  // namespace etlc::emit
