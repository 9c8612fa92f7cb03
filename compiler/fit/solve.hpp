// One fitted thing from what was collected.
// Takes: the model with what stands before it filled, and the folds to fit on. Gives: the numbers,
// or why there are none. Keeps true: all is computed in double and rounded once, to float32; a map
// fitted in between is the float32 one that the monitor computes with.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "check/points/project.hpp"
#include "fit/collect.hpp"

namespace etlc::fit {

struct Solution {
    check::Filling filling;
    Counts counts;                       ///< of the frames that it was fitted on
    std::optional<double> shrinkage;     ///< discriminant
    std::optional<double> explained;     ///< components: part of the variance
    std::uint64_t constant = 0;          ///< elements of the point that never change
    std::uint64_t taken = 0;             ///< kmeans, medoids: frames to choose from
    std::vector<const Source*> medoids;  ///< per row
};

/// Why there is no solution.
struct Refusal {
    diag::Code code = diag::Code::too_few_frames;
    std::string message;
};

/// The needs of all that the model has fitted, each once; `of`: per fitted thing, which one is its.
struct Needs {
    std::vector<Need> all;
    std::vector<std::size_t> of;

    /// Where it stands in `all`; there from now on.
    std::size_t add(const Need& need);
};
Needs needs_of(const check::Model& model);

/// `left_out`: a fold that is not fitted on.
std::variant<Solution, Refusal> solve(const check::Model& model, Index fitted,
                                      const Collection& collection, std::size_t need,
                                      std::optional<std::size_t> left_out);

}  // namespace etlc::fit
