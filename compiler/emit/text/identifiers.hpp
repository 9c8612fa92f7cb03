// Turns formulas and expressions into identifiers of generated code: words with underscores between
// them, at most kLongestName characters, the same on every run.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "ir/graph.hpp"

namespace etlc::emit {

inline constexpr std::size_t kLongestName = 24;

/// Turns "F (at_a && held)" into eventually_at_a_and_held. Returns `otherwise` if that is too long.
std::string identifier(std::string_view text, const std::string& otherwise);

/// Returns the formula as an identifier. If that is longer than `room`, its operator and one
/// operand: always_p_or_more. Empty if no word fits.
std::string name_of(const ir::Graph& graph, ir::NodeId node, std::size_t room = kLongestName);

/// Names a number that earlier steps have a part in: x_30_ago, mean_x_20. If that is too long, or
/// may change in a retargetable class, the name does not say what it is made of.
std::string name_of(const check::Model& model, const check::Past& past);

/// Returns the name of a max or min after one of its operands: "p_or_more".
std::string with_more(const std::string& operand, bool max);

// Shields generated code from macros: of platform headers, and single capital letters. Directives
// around the code remove macros with names that it uses, and restore them after it.

std::string shielded(const std::string& code);

/// Gives out each name once. The same calls in the same order return the same names.
class Scope {
public:
    explicit Scope(std::set<std::string> taken = {}) : taken_(std::move(taken)) {}
    /// Returns `wanted` + `mark`; if that is taken, wanted_2 + mark, wanted_3 + mark, ...
    std::string claim(const std::string& wanted, const std::string& mark = "");
    /// Returns wanted_1; if that is taken, wanted_2, wanted_3, ...
    std::string number(const std::string& wanted);

private:
    std::set<std::string> taken_;
};

}  // namespace etlc::emit
