// Recorded numbers as the samples that a monitor would have been given.
// Takes: an input and the doubles of a trace. Gives: float32 values as the generated class would
// see them. Keeps true: a float16 rounds once to float16, an int8 is scaled in float32; whether a
// sample counts as missing (not finite, out of range) is the evaluator's question, as it is the
// generated class's.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "data/recordings/open.hpp"

namespace etlc::plan {

/// One input at one step; no values: missing.
struct Sample {
    bool present = false;
    std::vector<float> values;
};

/// What a recording has of it.
data::Channel channel_of(const check::Input& input);

/// The sample, or nothing where a number is not of the input's type: `why` then says which and what
/// was expected.
std::optional<Sample> narrow(const check::Input& input, bool present,
                             const std::vector<double>& numbers, std::string& why);

}  // namespace etlc::plan
