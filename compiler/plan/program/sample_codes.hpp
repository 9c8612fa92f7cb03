// Codes of samples in a class that explains its verdicts, `--explain`. The code, with the step, is
// part of the rank of a value. Each predicate or bool has one code for present samples and one for
// missing ones; rows of targets have their own as long as kSteps steps can be distinguished.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "plan/program/program.hpp"

namespace etlc::plan {

struct Samples {
    /// Rows are distinguished where at least this many steps are: 11 hours at 100 Hz.
    static constexpr std::uint32_t kSteps = 1U << 22;

    /// A predicate of the model, or a bool input.
    struct Place {
        bool is_predicate = true;
        Index index = 0;
        std::uint32_t rows = 0;  ///< rows with codes of their own
        std::uint32_t first =
            0;  ///< its first code, then those of the rows, then that of a missing sample

        std::uint32_t codes() const { return (rows == 0 ? 1 : rows) + 1; }
    };
    std::vector<Place> places;  ///< in the order of the spec
    std::uint32_t codes = 0;    ///< number of all codes

    const Place& place_of(bool is_predicate, Index index) const;
};

/// Returns the samples of a plan in sourced values.
Samples samples(const Plan& plan);

/// Returns the bytes in the class.
std::uint64_t bytes_of(const Samples& samples, std::size_t monitors);

}  // namespace etlc::plan
