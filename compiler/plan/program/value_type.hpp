// What formulas are computed in: a row a type of values.
// Takes: what the user chose. Gives: the bytes that values and what is made of them take, and when
// they are found out. Keeps true: behind the plan nobody asks which type it is; the emitter has a
// row of words for each (emit/spelling.hpp).
#pragma once

#include <cstdint>

#include "check/model/model.hpp"

namespace etlc::plan {

struct ValueType {
    /// Predicates are measured when a verdict that can still change first depends on them, and a
    /// final verdict ends its monitor's work. Else on every step: robustness depends on all.
    bool on_demand;
    /// A value knows its sample, and the class can say which one decides a verdict.
    bool sourced;
    // Bytes of one, and of what the runtime makes of so many.
    std::uint64_t value;
    std::uint64_t reading;
    std::uint64_t verdict;
    std::uint32_t (*delay)(std::uint32_t length);
    std::uint32_t (*window)(std::uint32_t length);
    std::uint32_t (*since)(std::uint32_t length);
    std::uint32_t (*until)(std::uint32_t length);
    std::uint32_t (*handover)(std::uint32_t length);
};

const ValueType& value_type(check::Values values);

}  // namespace etlc::plan
