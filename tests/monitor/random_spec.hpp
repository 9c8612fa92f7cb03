// Random specs as .etl text.
// Takes: a seed and a shape. Gives: a valid spec. Keeps true: the same seed gives the same bytes.
// Inputs are scalars with and without ranges, a bool and an embedding of any element type, some
// with `hold` and `stale after`; predicates use all comparisons, distances, aggregations and
// expressions, of earlier steps too; formulas use all words and symbols of the operators, and lets.
#pragma once

#include <cstdint>
#include <string>

namespace etlc::tests {

struct SpecShape {
    enum class Formulas : std::uint8_t {
        unnested,           ///< temporal operators over Boolean combinations of atoms
        unbounded_nesting,  ///< future operators without bounds in each other, as F (a && F b) and
                            ///< G (a -> F b)
        prefix,             ///< any nesting that a prefix monitor takes
        sliding,            ///< sliding monitors: future bounded, past over future too
        chains,             ///< chains of at most `depth` phases
        mixed,              ///< prefix and sliding monitors in turn
        sequences,          ///< of at most `depth` phases, with bounded intervals
    };
    Formulas formulas = Formulas::unnested;
    int monitors = 8;
    int depth = 2;        ///< nesting of operators
    int window = 4;       ///< largest upper bound of an interval
    double future = 0.5;  ///< share of future operators
    /// Only expressions and distances that float32 computes without rounding on samples that are
    /// multiples of 1/4.
    bool exact = true;
    double restarts = 0;  ///< share of prefix monitors that are restartable or repeating
    double missing = 0;  ///< share of predicates and bools that say what a missing sample counts as
};

/// One spec of each kind of formulas, of a size that compiles in a second.
inline constexpr SpecShape kSmallShapes[] = {
    {.formulas = SpecShape::Formulas::unnested, .depth = 3},
    {.formulas = SpecShape::Formulas::unbounded_nesting, .depth = 3},
    {.formulas = SpecShape::Formulas::prefix, .monitors = 5, .depth = 3, .window = 3},
    {.formulas = SpecShape::Formulas::sliding, .depth = 3, .window = 3},
    {.formulas = SpecShape::Formulas::mixed, .depth = 3, .window = 3},
};

std::string random_spec(std::uint64_t seed, const SpecShape& shape);

}  // namespace etlc::tests
