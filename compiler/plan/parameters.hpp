// The parameters of a retargetable class: the numbers of its targets, thresholds, projections and
// expressions, in one block of bytes. Places depend on the shape of the plan only, not on any
// number. Numbers are little-endian float32, thresholds and numbers of expressions first, then
// arrays, each at a multiple of 64 bytes; the same plan gives the same bytes on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "etlmon/params/params.hpp"
#include "plan/plan.hpp"

namespace etlc::plan {

struct Parameter {
    enum class Kind : std::uint8_t {
        threshold,  ///< threshold of predicate `index`, or its two thresholds, ascending
        number,     ///< `number` in the expression of predicate `index`
        in_past,    ///< `number` in the expression of past number `index`
        rows,       ///< rows of distance `index` and of others to the same target
        weights,    ///< weights of distance `index`
        matrix,     ///< matrix of projection `index`
        offset      ///< offset of projection `index`
    };
    Kind kind = Kind::threshold;
    Index index = 0;
    const check::Expr* number = nullptr;
    std::uint32_t begin = 0;  ///< in floats from the start of the block
    std::uint32_t count = 1;
    std::uint32_t width = 1;  ///< width of a row
    etlmon::ParamsPart::Rule rule = etlmon::ParamsPart::any;
};

/// Returns all parameters of the plan, in the order of their places.
std::vector<Parameter> parameters(const Plan& plan);

/// Returns the size of the block.
std::uint64_t block_bytes(const std::vector<Parameter>& parameters);

/// Returns the XXH64 of a line per encoder of the spec, NAME FINGERPRINT; 0 without encoders.
std::uint64_t encoder_hash(const check::Model& model);

/// Returns the block for the class of this shape.
std::string block(const Plan& plan, std::uint64_t shape);

}  // namespace etlc::plan
