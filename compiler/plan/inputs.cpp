#include "plan/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etlc::plan {

namespace {

/// Nearest float16, ties to even, as a double.
double to_f16(double x) {
    if (!std::isfinite(x) || x == 0) return x;
    constexpr int kFractionBits = 10;
    constexpr int kLeastExponent = -14;
    constexpr double kLargest = 65504;
    const double quantum = std::ldexp(1.0, std::max(std::ilogb(x), kLeastExponent) - kFractionBits);
    const double rounded = std::nearbyint(x / quantum) * quantum;
    return std::abs(rounded) > kLargest ? std::copysign(HUGE_VAL, x) : rounded;
}

}  // namespace

std::optional<Sample> narrow(const check::Input& input, bool present, const std::vector<double>& numbers,
                             std::string& why) {
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
                why =
                    fmt::format("'{}[{}]' is {}, expected an int8: an integer from -128 to 127", input.name, i, number);
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
