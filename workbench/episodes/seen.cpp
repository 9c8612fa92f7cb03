#include "episodes/seen.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

namespace etlc::episodes {

namespace {

using check::Input;
using check::InputType;

/// A sample of fewer bits is like others by chance.
constexpr std::uint32_t kBitsThatTell = 32;

std::uint32_t bits_of(const Input& input) {
    switch (input.type) {
        case InputType::f32: return 32 * input.dimension;
        case InputType::f16: return 16 * input.dimension;
        case InputType::i8: return 8 * input.dimension;
        case InputType::scalar:
        case InputType::boolean: break;
    }
    return 0;
}

/// Under another declaration the same recording is seen otherwise, so it has another name.
std::string name_of(const Input& input) {
    std::string name = input.name;
    if (input.type == InputType::f16) name += " f16";
    if (input.type == InputType::i8) name += fmt::format(" i8 scale {:.9g}", input.scale);
    if (input.has_range)
        name += fmt::format(" in [{:.9g}, {:.9g}]", input.range.low, input.range.high);
    if (input.hold > 0) name += fmt::format(" hold {}", input.hold);
    if (input.missing) name += *input.missing ? " missing true" : " missing false";
    return name;
}

std::vector<data::HashedInput> hashed(const check::Model& model, const std::vector<Index>& inputs) {
    std::vector<data::HashedInput> result;
    for (const Index index : inputs) {
        const Input& input = model.inputs[index];
        result.push_back({name_of(input), input.dimension, bits_of(input) >= kBitsThatTell});
    }
    return result;
}

/// In a form that compilers turn into vectors.
bool are_finite(const std::vector<float>& values) {
    bool finite = true;
    for (const float x : values) finite &= std::abs(x) <= std::numeric_limits<float>::max();
    return finite;
}

bool is_there(const Input& input, const plan::Sample& sample) {
    return sample.present && !sample.values.empty() && are_finite(sample.values) &&
           (input.type != InputType::scalar || input.range.contains(sample.values[0]));
}

void see_as(const Input& input, const std::vector<float>& values, std::vector<float>& seen) {
    seen.resize(values.size());
    const bool is_bool = input.type == InputType::boolean;
    if (is_bool) seen[0] = values[0] != 0 ? 1 : 0;
    for (std::size_t i = is_bool ? 1 : 0; i < values.size(); ++i)
        seen[i] = values[i] + 0.0F;  // -0 becomes 0
}

}  // namespace

Seen::Seen(const check::Model& model, std::vector<Index> inputs)
    : model_(model),
      inputs_(std::move(inputs)),
      held_(inputs_.size()),
      seen_(inputs_.size()),
      hash_(hashed(model, inputs_)) {}

void Seen::add(const std::vector<plan::Sample>& samples) {
    for (std::size_t i = 0; i < inputs_.size(); ++i)
        see(model_.inputs[inputs_[i]], samples[inputs_[i]], held_[i], seen_[i]);
    hash_.add(seen_);
}

/// As plan::Evaluator takes inputs.
void Seen::see(const Input& input, const plan::Sample& sample, Held& held,
               std::vector<float>& seen) const {
    seen.clear();
    if (is_there(input, sample)) {
        see_as(input, sample.values, seen);
        if (input.hold > 0) held = {seen, 0};
        return;
    }
    if (!held.values.empty() && held.age < input.hold)
        seen = held.values;
    else if (input.missing)
        seen.push_back(*input.missing ? 1 : 0);
    if (held.age < input.hold) ++held.age;
}

}  // namespace etlc::episodes
