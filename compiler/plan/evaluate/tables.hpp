// What an evaluator computes once from a plan: rows as kernels read them. It does not change, so
// evaluators of the same plan share it.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "plan/evaluate/near_rows.hpp"
#include "plan/evaluate/state.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

struct Tables {
    /// The plan outlives it.
    explicit Tables(const Plan& plan);

    std::vector<Index> flags;                  ///< bools of the model that formulas read
    std::vector<Index> measured_points;        ///< points of the model, each after its inner one
    Shape shape;                               ///< of a state
    std::vector<std::vector<float>> prepared;  ///< per distance: prepared rows
    std::vector<std::vector<float>> widened;   ///< per distance: its narrow rows, widened
    std::vector<const NarrowSet*> narrow;      ///< per distance: its narrow rows; null: none
    /// For distances by full weights to the nearest row: how to find candidates.
    std::map<Index, NearRows> near;
    /// Per predicate: where its difference changes the comparison, for narrow targets.
    std::vector<std::vector<Cut>> contrast_cuts;
    std::size_t near_values = 0;  ///< most floats of candidate rows
    std::size_t scratch = 0;      ///< floats that kernels need
    std::size_t centred = 0;      ///< floats that projections need

private:
    void take_shape(const Plan& plan);
    void prepare(const Plan& plan, Index distance);
};

}  // namespace etlc::plan
