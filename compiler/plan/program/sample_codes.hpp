// What samples are called in a class that explains its verdicts: `--explain`.
// Takes: the plan. Gives: which predicates and bools they are of, and their codes, which stand with
// the step in the rank of a value. Keeps true: each has a code of its own where it was there and
// one where it was missing; rows of targets have their own while kSteps steps can be told apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "plan/program/program.hpp"

namespace etlc::plan {

struct Samples {
    /// Rows are told apart where at least so many steps are: 11 hours at 100 Hz.
    static constexpr std::uint32_t kSteps = 1U << 22;

    /// A predicate of the model, or a bool input.
    struct Place {
        bool is_predicate = true;
        Index index = 0;
        std::uint32_t rows = 0;  ///< that are told apart
        std::uint32_t first =
            0;  ///< its code; those of the rows follow, then that of a missing one

        std::uint32_t codes() const { return (rows == 0 ? 1 : rows) + 1; }
    };
    std::vector<Place> places;  ///< in the order in which the spec first says them
    std::uint32_t codes = 0;    ///< of all

    const Place& place_of(bool is_predicate, Index index) const;
};

/// Of a plan in values that know their sample.
Samples samples(const Plan& plan);

/// In the class.
std::uint64_t bytes_of(const Samples& samples, std::size_t monitors);

}  // namespace etlc::plan
