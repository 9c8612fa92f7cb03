#include "plan/evaluate/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "plan/targets/narrow_targets.hpp"

namespace etlc::plan {

data::Channel channel_of(const check::Input& input) {
    const auto kind = input.type == check::InputType::boolean ? data::Channel::Kind::boolean
                      : input.is_embedding()                  ? data::Channel::Kind::vector
                                                              : data::Channel::Kind::scalar;
    return {input.name, kind, input.dimension};
}

std::optional<Sample> narrow(const check::Input& input, bool present,
                             const std::vector<double>& numbers, std::string& why) {
    Sample sample;
    if (!present) return sample;
    sample.present = true;
    if (input.type != check::InputType::f16 && input.type != check::InputType::i8) {
        sample.values.assign(numbers.begin(), numbers.end());
        return sample;
    }
    sample.values.reserve(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        double number = numbers[i];
        if (input.type == check::InputType::f16) number = to_f16(number);
        if (input.type == check::InputType::i8) {
            if (!(number >= -128 && number <= 127 && number == std::floor(number))) {
                why = fmt::format("'{}[{}]' is {}, expected an int8: an integer from -128 to 127",
                                  input.name, i, number);
                return std::nullopt;
            }
            // An int8 has no -0.
            sample.values.push_back((static_cast<float>(number) + 0.0F) * input.scale);
            continue;
        }
        sample.values.push_back(static_cast<float>(number));
    }
    return sample;
}

bool Freshness::accepts(const check::Input& input, const std::vector<float>& values) {
    if (input.stale_after == 0) return true;
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    const bool same =
        repeats_ > 0 && std::equal(values.begin(), values.end(), last_.begin(), last_.end(),
                                   [&](float a, float b) { return bits(a) == bits(b); });
    if (!same) {
        last_ = values;
        repeats_ = 0;
    }
    if (repeats_ == input.stale_after) return false;
    ++repeats_;
    return true;
}

}  // namespace etlc::plan
