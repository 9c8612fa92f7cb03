// The parameters of a retargetable class: all numbers of the spec that its targets, thresholds,
// projections and expressions are made of, in one block of bytes.
// Takes: a plan. Gives: where in the block each number lies, what must hold for it, and the block.
// Keeps true: places depend on the shape of the plan alone, not on any number; numbers are
// little-endian float32, thresholds and numbers of expressions first, then arrays, each at a
// multiple of 64 bytes; the same plan gives the same bytes on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "etlmon/params/params.hpp"
#include "plan/plan.hpp"

namespace etlc::plan {

struct Parameter {
    enum class Kind : std::uint8_t {
        threshold,  ///< of predicate `index`
        number,     ///< in the expression of predicate `index`: `number`
        rows,       ///< of distance `index` and others to the same rows
        weights,    ///< of distance `index`
        matrix,     ///< of projection `index`
        offset      ///< of projection `index`
    };
    Kind kind = Kind::threshold;
    Index index = 0;
    const check::Expr* number = nullptr;
    std::uint32_t begin = 0;  ///< in floats from the first byte of the block
    std::uint32_t count = 1;
    std::uint32_t width = 1;  ///< of a row
    etlmon::ParamsPart::Rule rule = etlmon::ParamsPart::any;
};

/// All of the plan, in the order of their places.
std::vector<Parameter> parameters(const Plan& plan);

/// What the block takes with them.
std::uint64_t block_bytes(const std::vector<Parameter>& parameters);

/// XXH64 of a line an encoder of the spec, NAME FINGERPRINT; 0 where there is none.
std::uint64_t encoder_hash(const check::Model& model);

/// The block, for the class of this shape.
std::string block(const Plan& plan, std::uint64_t shape);

}  // namespace etlc::plan
