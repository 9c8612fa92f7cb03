// Converts recorded numbers to the samples that a monitor gets: a float16 rounds once to float16,
// an int8 is scaled in float32. Whether a sample counts as missing (not finite, out of range) is up
// to the evaluator, as to the generated class.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "data/recordings/open.hpp"

namespace etlc::plan {

/// A sample of one input; without values where missing.
struct Sample {
    bool present = false;
    std::vector<float> values;
};

/// Returns the channel of an input in a recording.
data::Channel channel_of(const check::Input& input);

/// Returns the sample, or nothing where a number is not of the input's type; sets `why` to what was
/// found and expected.
std::optional<Sample> narrow(const check::Input& input, bool present,
                             const std::vector<double>& numbers, std::string& why);

}  // namespace etlc::plan
