// The value types of formulas: the sizes of values and of what contains them, and whether they are
// evaluated on demand. After planning nothing branches on the type; the emitter has a row of words
// for each (emit/spelling.hpp).
#pragma once

#include <cstdint>

#include "check/model/model.hpp"

namespace etlc::plan {

struct ValueType {
    /// Whether predicates are measured only when a verdict that can still change depends on them,
    /// and a final verdict ends the work of its monitor. Robustness depends on all predicates at
    /// every step.
    bool on_demand;
    /// Whether a value carries its sample, so that the class can name the one that decides a
    /// verdict.
    bool sourced;
    // bytes of one, and of containers of this length
    std::uint64_t value;
    std::uint64_t reading;
    std::uint64_t verdict;
    std::uint32_t (*delay)(std::uint32_t length);
    std::uint32_t (*window)(std::uint32_t length);
    std::uint32_t (*since)(std::uint32_t length);
    std::uint32_t (*until)(std::uint32_t length);
    std::uint32_t (*handover)(std::uint32_t length);
    std::uint32_t (*count)(std::uint32_t n, std::uint32_t length);
};

const ValueType& value_type(check::Values values);

}  // namespace etlc::plan
