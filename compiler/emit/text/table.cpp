#include "emit/text/table.hpp"

#include <algorithm>

#include "emit/text/layout.hpp"

namespace etlc::emit {

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
