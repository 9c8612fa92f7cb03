// What a plan costs: bytes of state and constants, estimated code, operations of the worst step.
// Takes: a plan. Gives: the figures of `--emit report` and of the generated header's table.
// Keeps true: state_bytes is exactly the size of the generated class; stack_bytes the arrays of its
// step; operations count every min, max and comparison of two keys that the worst step performs (a
// Value has two keys); code_bytes is an estimate.
#pragma once

#include "plan/budget/limits.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

Cost operator+(Cost a, const Cost& b);
bool within(const Cost& cost, const Limits& limits);
/// "12 bytes of state, 216 bytes of code (estimated), 3 operations a step"
std::string in_words(const Cost& cost);
Cost cost_of(const Stream& stream, check::Values values);
Cost cost_of(const Reading& reading, check::Values values);
/// Target elements that a predicate measures.
std::uint64_t measured_elements(const check::Model& model, Index predicate);
/// The same with those of the projections that stand before it.
std::uint64_t elements_of(const check::Model& model, Index predicate);
/// Of a state machine of this size, as a table.
Cost cost_of_table(std::size_t states, std::size_t transitions, check::Values values);
/// Fills in plan.cost and plan.monitor_costs.
void add_costs(Plan& plan);

}  // namespace etlc::plan
