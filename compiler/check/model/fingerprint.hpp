// Identifies what a monitor was made from by three XXH64 hashes, for generated code and for
// everything that records which monitor gave a verdict (docs/generated_code.md lists the hashed
// bytes). They are the same on every machine; of the options of etlc, only --set changes one.
#pragma once

#include <cstdint>
#include <string>

#include "check/model/model.hpp"

namespace etlc::check {

struct Fingerprint {
    std::uint64_t spec = 0;        ///< the bytes of the spec's file, and the effect of --set
    std::uint64_t data = 0;        ///< target sets and weights; 0 if there are none
    std::uint64_t thresholds = 0;  ///< named thresholds and shifts; 0 if there are none
};

Fingerprint fingerprint(const Model& model);

/// Returns the content hash of a distance's weights, 16 hex digits.
std::string weights_hash(const Distance& distance);

}  // namespace etlc::check
