#include "plan/evaluate/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
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
            sample.values.push_back(static_cast<float>(number) * input.scale);
            continue;
        }
        sample.values.push_back(static_cast<float>(number));
    }
    return sample;
}

}  // namespace etlc::plan
