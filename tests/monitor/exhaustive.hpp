// Every operator over every short trace.
// Gives: a spec with a monitor for each operator and interval, each Boolean connective and the
// usual nestings over two predicates p and q; specs with predicates over earlier steps; and all
// traces of a length over the relevant values.
// Keeps true: p and q have values of different size, so a verdict shows which of them decided it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "reference/reference.hpp"

namespace etlc::tests {

/// Prefix monitors m0, m1, ... over p = x >= 0 and q = y > 0; `kind` may be "restartable monitor"
/// or "repeating monitor".
std::string exhaustive_spec(const std::string& name = "exhaustive",
                            const std::string& kind = "monitor");
/// Sliding monitors, with bounded futures and past operators over them.
std::string exhaustive_sliding_spec(const std::string& name = "exhaustive_sliding");

/// The kinds of chains: one formula waits for the next.
const std::vector<std::string>& chain_kinds();
/// Returns a chain of a kind through these operands, at least one, in this order.
std::string chain(const std::string& kind, const std::vector<std::string>& operands);
/// Monitors of every kind of chain with 1 to `phases` phases over p, q and formulas of the past.
std::string exhaustive_chains_spec(const std::string& name = "chains",
                                   const std::string& kind = "monitor", std::size_t phases = 8);

struct PastShape {
    bool points = false;     ///< embeddings of one element; otherwise scalars
    std::size_t inputs = 1;  ///< 1 or 2
    std::string kind = "monitor";
    std::string of_inputs = {};  ///< as " hold 1", of the first input
};
/// Monitors over earlier samples and numbers, and sliding ones: delays, windows, points put
/// together, and distances between points.
std::string exhaustive_past_spec(const std::string& name, const PastShape& shape);

/// Returns all traces of `steps` steps over one input in {-1, 2}, and a second in {-2, 1}: 4^steps;
/// with `gaps` either may be missing: 9^steps.
class AllTraces {
public:
    AllTraces(std::size_t steps, bool gaps, std::size_t inputs = 2);
    std::size_t size() const { return size_; }
    reference::Trace operator[](std::size_t number) const;

private:
    std::size_t steps_;
    std::size_t values_;
    std::size_t inputs_;
    std::size_t size_ = 1;
};

}  // namespace etlc::tests
