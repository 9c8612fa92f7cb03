// Which formulas have one verdict whatever the inputs are.
// Takes: the formulas of the model; predicates count as able to change. Gives: for each formula its
// constant, if it has one. Keeps true: what is called constant has robustness +inf or -inf at every
// position that a prefix can have.
#pragma once

#include <cstdint>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

enum class Constancy : std::uint8_t { varies, always, never };

struct Constancies {
    Constancy anywhere = Constancy::varies;  ///< at every position
    Constancy at_start = Constancy::varies;  ///< at position 0, which has no past
};

/// Parallel to model.formulas.
std::vector<Constancies> constancies(const Model& model);

}  // namespace etlc::check
