// Time: the length of a step, and interval bounds in steps.
// Takes: rates, periods and durations as exact decimal fractions. Gives: whole numbers of steps.
// Keeps true: only what the spec says is rounded: 0.29 s at 100 Hz is 29 steps.
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

/// Neither a number of steps nor inf.
bool is_duration(const ast::Bound& bound);

/// The bound in steps; nothing where it had an error, which is reported.
std::optional<std::uint32_t> bound_steps(Context& context, const ast::Bound& bound);

/// Not inf: the bound of `held`. An error, which is reported, otherwise.
bool is_finite_duration(Context& context, const ast::Bound& bound);

/// The interval in steps; nothing where it had an error, which is reported.
std::optional<Steps> interval_steps(Context& context, const ast::Interval& interval);

/// In a spec with a rate, of bounds that count steps and do not say so: 2 may be meant as 2 s.
void warn_of_bare_bounds(Context& context);

}  // namespace etlc::check
