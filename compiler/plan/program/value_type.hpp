// The value types of formulas: the sizes of values and of what contains them, and whether they are
// evaluated on demand. After planning nothing branches on the type; the emitter has a row of words
// for each (emit/names.hpp).
#pragma once

#include <cstdint>

#include "check/model/model.hpp"
#include "etlmon/distance/enclosed.hpp"
#include "etlmon/temporal/adaptation.hpp"

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

// Values of predicates, as robustness or as truth values. Truth values are +inf and -inf, so that
// everything above works on one type; a NaN delta is unknown, which is the whole range.

/// Returns the lowest and highest value of a predicate: the range of its robustness, or the
/// possible truth values of its comparison over the ranges of its expression and its threshold.
etlmon::Value unseen_range(const check::Predicate& predicate, check::Values values);

/// Returns the value of a predicate at a step without its sample: its range, or what the spec's
/// `missing` says.
etlmon::Value missing_value(const check::Predicate& predicate, check::Values values);

/// Returns the value of a bool input at a step without its sample.
etlmon::Value missing_value(const check::Input& input);

/// Returns the value of a predicate for a delta and the threshold of this step, or two thresholds.
etlmon::Value value_of(const check::Predicate& predicate, float delta, float epsilon,
                       const std::optional<float>& inner, check::Values values);
inline etlmon::Value value_of(const check::Predicate& predicate, float delta, float epsilon,
                              check::Values values) {
    return value_of(predicate, delta, epsilon, predicate.threshold.inner, values);
}
/// Returns the robustness for a distance known within bounds.
etlmon::Value value_of(const check::Predicate& predicate, const etlmon::Enclosed& delta,
                       float epsilon);

/// Returns the threshold of an adaptive predicate after a positive frame at this distance.
float observed(const check::Predicate& predicate, float epsilon, float distance);

/// Returns the adaptation as generated code states it.
etlmon::Adaptation runtime_adaptation(const check::Adaptation& adaptation, bool upper_bound);

}  // namespace etlc::plan
