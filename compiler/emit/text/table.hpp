// Tables of text: in a comment of the header, or in a report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emit/text/printer.hpp"

namespace etlc::emit {

using Row = std::vector<std::string>;

/// In a cell: a formula's beginning, where it is long; a number.
std::string shortened(const std::string& formula);
std::string number(std::uint64_t x);

/// Lines behind this prefix are a comment, and no wider than code.
bool is_comment(const std::string& prefix);

/// Numbers, which are all columns from `first_number` on, stand to the right.
void print_table(Printer& out, const std::string& prefix, const std::vector<Row>& rows,
                 std::size_t first_number);

}  // namespace etlc::emit
