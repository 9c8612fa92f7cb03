// The flight recorder of a class, `--recorder BEFORE,AFTER,INCIDENTS`: the layout of its rows and
// its size. The emitted class and the reader of incidents share this layout; etlmon::Recorder has
// exactly these bytes.
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
    std::string text;  ///< as given on the command line
};

struct RecorderRequest {
    Length before;
    Length after;
    std::uint32_t incidents = 0;
};

/// Plans the recorder, or reports durations without a rate or state beyond the limits.
void add_recorder(Plan& plan, const RecorderRequest& request, const Limits& limits,
                  diag::Sink& sink);

/// The columns of a step, in order: figures are words, bools and verdicts bytes.
struct RecorderColumns {
    struct OfPredicate {
        Index predicate = 0;
        std::uint32_t figure = 0;    ///< index of its first figure, the distance or expression
        std::vector<Index> nearest;  ///< distances whose nearest rows follow
        bool threshold = false;      ///< then the threshold, if it adapts
    };
    std::vector<OfPredicate> predicates;
    std::vector<Index> bools;    ///< inputs
    std::uint32_t figures = 0;   ///< words of a row, besides the number of the step
    std::uint32_t monitors = 0;  ///< all monitors of the plan
    std::uint64_t row_bytes() const;
};
RecorderColumns recorder_columns(const Plan& plan);

/// Returns the XXH64 of a line per column: its kind and its name.
std::uint64_t columns_hash(const Plan& plan);

/// Returns the name of a predicate, or its comparison where it has none.
std::string column_name(const check::Model& model, Index predicate);

/// Returns the bytes of the recorder in the class.
std::uint64_t recorder_bytes(const Plan& plan);

/// Returns the largest size of a written incident.
std::uint64_t incident_bytes(const Plan& plan);

}  // namespace etlc::plan
