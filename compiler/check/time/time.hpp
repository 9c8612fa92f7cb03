// The length of a step, and interval bounds in steps, computed exactly: 0.29 s at 100 Hz is 29
// steps. Rounding happens only where the spec asks for it.
#pragma once

#include <cstdint>
#include <optional>

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

struct Steps {
    std::uint32_t low = 0;
    std::uint32_t high = 0;
};

/// Whether the bound is neither a number of steps nor inf.
bool is_duration(const ast::Bound& bound);

/// Returns the bound in steps; nothing after an error.
std::optional<std::uint32_t> bound_steps(Context& context, const ast::Bound& bound);

/// Whether the bound is finite; reports an error with the reason otherwise.
bool is_finite_duration(Context& context, const ast::Bound& bound, std::string_view why,
                        std::string_view instead = "");

/// Returns a lower bound in steps, which is finite; nothing after an error.
std::optional<std::uint32_t> lower_steps(Context& context, const ast::Bound& bound);

/// Returns the interval in steps; nothing after an error.
std::optional<Steps> interval_steps(Context& context, const ast::Interval& interval);

/// Returns "[0.5 s, inf]"; "[5 steps, inf]" without a rate, and where a bound is no decimal number
/// of seconds.
std::string interval_text(const Context& context, std::uint64_t low, std::uint64_t high);

/// Warns of bounds without a unit in a spec with a rate: 2 may be meant as 2 s.
void warn_of_bare_bounds(Context& context);

}  // namespace etlc::check
