// What a class that explains its verdicts remembers of samples: `--explain`.
// Takes: the plan. Gives: which predicates and bools they are of, how many steps are remembered,
// how many values are followed beyond these, and the bytes of that. Keeps true: etlmon::Samples of
// it has exactly these bytes; what the class makes of samples alone, for a bounded time, is that of
// one of the last `steps`.
#pragma once

#include <cstdint>
#include <vector>

#include "plan/plan.hpp"

namespace etlc::plan {

struct Samples {
    /// A predicate of the model, or a bool input.
    struct Place {
        bool is_predicate = true;
        Index index = 0;
    };
    std::vector<Place> places;   ///< in the order in which the spec first says them
    bool has_rows = false;       ///< some predicate has a nearest target
    bool adapts = false;         ///< the threshold of some predicate does
    std::uint32_t steps = 1;     ///< the last ones, of which everything is remembered
    std::uint32_t followed = 0;  ///< values that may outlive these, one at least

    std::uint32_t place_of(bool is_predicate, Index index) const;
};

/// Of a plan in values that know their sample.
Samples samples(const Plan& plan);

/// In the class.
std::uint64_t bytes_of(const Samples& samples, std::size_t monitors);

/// A member that holds what is not forgotten after some steps.
bool is_followed(const Member& member);

}  // namespace etlc::plan
