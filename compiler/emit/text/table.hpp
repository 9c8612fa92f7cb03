// Prints tables of text, in a comment of the header or in a report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emit/text/printer.hpp"

namespace etlc::emit {

using Row = std::vector<std::string>;

/// Returns the text of a cell: a formula, cut if it is long; a number.
std::string shortened(const std::string& formula);
std::string number(std::uint64_t x);

/// Returns whether lines with this prefix are a comment, which is no wider than code.
bool is_comment(const std::string& prefix);

/// Prints a table. Columns from `first_number` on are numbers, and right-aligned.
void print_table(Printer& out, const std::string& prefix, const std::vector<Row>& rows,
                 std::size_t first_number);

}  // namespace etlc::emit
