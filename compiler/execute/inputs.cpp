#include "execute/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "plan/targets/narrow_targets.hpp"

namespace etlc::execute {

using namespace plan;

data::Channel channel_of(const check::Input& input) {
    const auto kind = input.type == check::InputType::boolean ? data::Channel::Kind::boolean
                      : input.is_embedding()                  ? data::Channel::Kind::vector
                                                              : data::Channel::Kind::scalar;
    return {input.name, kind, input.dimension};
}

std::optional<Sample> narrow(const check::Input& input, bool present,
                             const std::vector<double>& numbers, std::string& why, Sample reused) {
    Sample sample{present, std::move(reused.values)};
    sample.values.clear();
    if (!present) return sample;
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

namespace {

/// Adding one to the exponent carries into the sign if and only if all its bits are set.
inline bool are_finite(const float* elements, std::size_t count) {
    std::uint32_t worst = 0;
    for (std::size_t i = 0; i < count; ++i)
        worst |= (std::bit_cast<std::uint32_t>(elements[i]) & 0x7f80'0000U) + 0x0080'0000U;
    return (worst & 0x8000'0000U) == 0;
}

#if defined(__x86_64__)
__attribute__((target("avx512f"))) bool are_finite_by_16(const float* elements, std::size_t count) {
    return are_finite(elements, count);
}
__attribute__((target("avx2"))) bool are_finite_by_8(const float* elements, std::size_t count) {
    return are_finite(elements, count);
}
#endif

}  // namespace

bool all_finite(const float* elements, std::size_t count) {
#if defined(__x86_64__)
    static const bool by_16 = __builtin_cpu_supports("avx512f") != 0;
    static const bool by_8 = __builtin_cpu_supports("avx2") != 0;
    if (by_16 && count >= 64) return are_finite_by_16(elements, count);
    if (by_8 && count >= 32) return are_finite_by_8(elements, count);
#endif
    return are_finite(elements, count);
}

bool Freshness::accepts(const check::Input& input, std::span<const float> values) {
    if (input.stale_after == 0) return true;
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    const bool same =
        repeats_ > 0 && std::equal(values.begin(), values.end(), last_.begin(), last_.end(),
                                   [&](float a, float b) { return bits(a) == bits(b); });
    if (!same) {
        last_.assign(values.begin(), values.end());
        repeats_ = 0;
    }
    if (repeats_ == input.stale_after) return false;
    ++repeats_;
    return true;
}

}  // namespace etlc::execute
