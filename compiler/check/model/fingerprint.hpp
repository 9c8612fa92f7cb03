// What a monitor was made from, as three numbers: for the head of generated code, and for whatever
// has to say later which monitor a verdict came from.
// Takes: the model. Gives: XXH64 of the spec, of its data and of its thresholds
// (docs/generated_code.md says of which bytes). Keeps true: the same on every machine; of the
// options of etlc, only --set changes one.
#pragma once

#include <cstdint>
#include <string>

#include "check/model/model.hpp"

namespace etlc::check {

struct Fingerprint {
    std::uint64_t spec = 0;        ///< of the bytes of the spec's file, and of what --set set
    std::uint64_t data = 0;        ///< of target sets and weights; 0 where there are none
    std::uint64_t thresholds = 0;  ///< of all named thresholds and shifts; 0 where there are none
};

Fingerprint fingerprint(const Model& model);

/// Content hash of a distance's weights, 16 hex digits.
std::string weights_hash(const Distance& distance);

}  // namespace etlc::check
