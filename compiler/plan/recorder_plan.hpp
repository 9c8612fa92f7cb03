// The flight recorder of a class: `--recorder BEFORE,AFTER,INCIDENTS`.
// Takes: the plan and what the call asks for. Gives: what a row of it holds and where, and its
// bytes. Keeps true: the class that is emitted and the reader of incidents have one layout, this
// one; etlmon::Recorder of it has exactly these bytes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plan/plan.hpp"

namespace etlc::plan {

/// A number of steps, or a time.
struct Length {
    double number = 0;
    bool in_seconds = false;
    std::string text;  ///< as the call says it
};

struct RecorderRequest {
    Length before;
    Length after;
    std::uint32_t incidents = 0;
};

/// Plans it, or reports why not: durations without a rate, or more state than the limits allow.
void add_recorder(Plan& plan, const RecorderRequest& request, const Limits& limits,
                  diag::Sink& sink);

/// What is recorded of a step, in order: figures are words, bools and verdicts bytes.
struct RecorderColumns {
    struct OfPredicate {
        Index predicate = 0;
        std::uint32_t figure = 0;    ///< the first of its figures: the distance or expression
        std::vector<Index> nearest;  ///< then, of each of these distances, the nearest row
        bool threshold = false;      ///< then the threshold, which adapts
    };
    std::vector<OfPredicate> predicates;
    std::vector<Index> bools;    ///< inputs
    std::uint32_t figures = 0;   ///< words of a row, beside the number of the step
    std::uint32_t monitors = 0;  ///< all of the plan
    std::uint64_t row_bytes() const;
};
RecorderColumns recorder_columns(const Plan& plan);

/// XXH64 of a line a column, in order: its kind and its name.
std::uint64_t columns_hash(const Plan& plan);

/// What a predicate is called: its name, or its comparison where it has none.
std::string column_name(const check::Model& model, Index predicate);

/// In the class.
std::uint64_t recorder_bytes(const Plan& plan);

/// The most that an incident of the plan's recorder takes, as it is written.
std::uint64_t incident_bytes(const Plan& plan);

}  // namespace etlc::plan
