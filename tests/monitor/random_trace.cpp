#include "random_trace.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "random.hpp"
#include "recordings/open.hpp"

namespace etlc::tests {
namespace {

using check::InputType;

std::vector<double> valid_sample(Random& random, const check::Input& input, bool grid) {
    std::vector<double> sample;
    for (std::uint32_t n = 0; n < input.dimension; ++n) {
        if (input.type == InputType::boolean)
            sample.push_back(random.between(0, 1));
        else if (input.type == InputType::i8)
            sample.push_back(static_cast<double>(input.scale) * random.between(-16, 16));
        else if (grid || input.type == InputType::f16)
            sample.push_back(random.grid(-4, 4, 0.25));
        else
            sample.push_back(static_cast<float>(random.uniform() * 8 - 4));
    }
    return sample;
}

/// Makes a sample that counts as missing or, a zero vector, as unknown to some predicates.
std::vector<double> invalid_sample(Random& random, const check::Input& input) {
    std::vector<double> sample(input.dimension, 0.0);
    if (input.type == InputType::boolean) return {};
    if (input.type == InputType::i8) return sample;  // every integer is valid: the zero vector
    const double infinity = std::numeric_limits<double>::infinity();
    switch (random.between(0, 3)) {
        case 0: sample.back() = std::nan(""); break;
        case 1: sample.front() = random.chance(0.5) ? infinity : -infinity; break;
        case 2:
            if (!input.is_embedding()) sample.front() = random.chance(0.5) ? 4.25 : -4.25;
            break;
        default: break;
    }
    return sample;
}

/// Multiples of 1/4 that float32 adds and squares without rounding.
std::vector<double> extreme_sample(Random& random, const check::Input& input) {
    constexpr double kFar = 64;
    std::vector<double> sample = valid_sample(random, input, true);
    if (input.type == InputType::boolean) return sample;
    const double end = input.is_embedding() ? 4 : kFar;
    for (double& value : sample) {
        value = random.chance(0.5) ? end : -end;
        if (input.type != InputType::scalar) continue;
        value = std::min(value, static_cast<double>(input.range.high));
        value = std::max(value, static_cast<double>(input.range.low));
    }
    return sample;
}

/// Returns the last sample once more, sometimes with a zero of the other sign, which is another
/// sample. An int8 has only one zero.
std::vector<double> repeated_sample(Random& random, const check::Input& input,
                                    std::vector<double> sample) {
    const bool flips = input.type != InputType::i8 && random.chance(0.2);
    for (double& value : sample)
        if (flips && value == 0) value = -value;
    return sample;
}

std::vector<std::string> columns(const check::Input& input) {
    if (!input.is_embedding()) return {input.name};
    std::vector<std::string> result;
    for (std::uint32_t n = 0; n < input.dimension; ++n)
        result.push_back(fmt::format("{}[{}]", input.name, n));
    return result;
}

/// Files hold the integers of an i8 embedding, the reference takes the real values.
double unit(const check::Input& input) {
    return input.type == InputType::i8 ? static_cast<double>(input.scale) : 1.0;
}

std::vector<double> real_values(const check::Input& input, std::vector<double> numbers) {
    for (double& number : numbers) number *= unit(input);
    return numbers;
}

double recorded(const check::Input& input, double value) {
    return value / unit(input);
}

}  // namespace

reference::Trace random_trace(const check::Model& model, std::uint64_t seed,
                              const TraceShape& shape) {
    Random random(seed);
    reference::Trace trace;
    std::vector<std::vector<double>> last(model.inputs.size());  // the last sample of each input
    for (std::size_t n = 0; n < shape.steps; ++n) {
        reference::Step step;
        for (const check::Input& input : model.inputs) {
            std::vector<double>& before = last[step.size()];
            if (random.chance(shape.missing))
                step.emplace_back();
            else if (input.stale_after > 0 && !before.empty() && random.chance(0.6))
                step.push_back(repeated_sample(random, input, before));
            else if (random.chance(shape.invalid))
                step.push_back(invalid_sample(random, input));
            else if (shape.extreme > 0 && random.chance(shape.extreme))
                step.push_back(extreme_sample(random, input));
            else
                step.push_back(valid_sample(random, input, shape.grid));
            if (!step.back().empty()) before = step.back();
        }
        trace.push_back(std::move(step));
    }
    return trace;
}

std::string to_csv(const check::Model& model, const reference::Trace& trace) {
    std::string result;
    for (const check::Input& input : model.inputs)
        for (const std::string& column : columns(input))
            result += (result.empty() ? "" : ",") + column;
    result += '\n';
    for (const reference::Step& step : trace) {
        std::string line;
        for (std::size_t n = 0; n < model.inputs.size(); ++n)
            for (std::uint32_t element = 0; element < model.inputs[n].dimension; ++element) {
                if (n + element > 0) line += ',';
                if (!step[n].empty())
                    line += fmt::format("{:.17g}", recorded(model.inputs[n], step[n][element]));
            }
        result += line + '\n';
    }
    return result;
}

reference::Trace read_csv(const check::Model& model, const std::string& path) {
    std::vector<data::Channel> channels;
    for (const check::Input& input : model.inputs) {
        const auto kind = input.type == InputType::boolean ? data::Channel::Kind::boolean
                          : input.is_embedding()           ? data::Channel::Kind::vector
                                                           : data::Channel::Kind::scalar;
        channels.push_back({input.name, kind, input.dimension});
    }
    reference::Trace result;
    auto trace = recordings::open_trace(path, channels);
    if (!trace) {
        ADD_FAILURE() << trace.failure().message;
        return result;
    }
    data::Sample sample;
    for (auto more = (*trace)->next(sample);; more = (*trace)->next(sample)) {
        if (!more) ADD_FAILURE() << more.failure().message;
        if (!more || !*more) return result;
        reference::Step step;
        for (std::size_t n = 0; n < channels.size(); ++n)
            step.push_back(sample.present[n] ? real_values(model.inputs[n], sample.values[n])
                                             : std::vector<double>{});
        result.push_back(std::move(step));
    }
}

}  // namespace etlc::tests
