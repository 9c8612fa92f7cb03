// Finds formulas whose verdict does not depend on the inputs, where predicates may have any value.
// A constant formula has robustness +inf or -inf at every position of every prefix.
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
