// Formulas and expressions as identifiers of generated code.
// Takes: their text, or the graph. Gives: words with underscores between them. Keeps true: legal
// C++, of at most kLongestName characters, the same on every run.
#pragma once

#include <string>
#include <string_view>

#include "ir/graph.hpp"

namespace etlc::emit {

inline constexpr std::size_t kLongestName = 24;

/// "F (at_a && held)" is eventually_at_a_and_held; too long ones give `otherwise`.
std::string identifier(std::string_view text, const std::string& otherwise);

/// The formula in its own words; where these are too many for `room` characters, its operator and
/// one of its operands: always_p_or_more. Empty where no word fits.
std::string name_of(const ir::Graph& graph, ir::NodeId node, std::size_t room = kLongestName);

/// "p_or_more": what a max or min of several is called after one of them.
std::string with_more(const std::string& operand, bool max);

}  // namespace etlc::emit
