#include "generated_wire.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace etlc::tests {
namespace {

using check::InputType;

template <class T>
void put(std::string& bytes, T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
}

/// Returns the bits of a float16 that holds `value` exactly, an infinity or a NaN.
std::uint16_t float16_bits(double value) {
    const int sign = std::signbit(value) ? 0x8000 : 0;
    if (std::isnan(value)) return static_cast<std::uint16_t>(sign | 0x7e00);
    if (std::isinf(value)) return static_cast<std::uint16_t>(sign | 0x7c00);
    if (value == 0) return static_cast<std::uint16_t>(sign);
    int exponent = 0;
    const double fraction = std::frexp(std::abs(value), &exponent);  // in [0.5, 1)
    const double significand = std::ldexp(fraction, 11);             // in [1024, 2048)
    const int biased = exponent + 14;
    if (significand != std::floor(significand) || biased < 1 || biased > 30)
        throw std::out_of_range("not a normal float16");
    return static_cast<std::uint16_t>(sign | biased << 10 | (static_cast<int>(significand) - 1024));
}

void put_element(std::string& bytes, const check::Input& input, double value) {
    switch (input.type) {
        case InputType::boolean: return put(bytes, static_cast<std::uint8_t>(value != 0));
        case InputType::f16: return put(bytes, float16_bits(value));
        case InputType::i8:
            return put(bytes, static_cast<std::int8_t>(value / static_cast<double>(input.scale)));
        case InputType::scalar:
        case InputType::f32: return put(bytes, static_cast<float>(value));
    }
}

}  // namespace

std::string encode_sample(const check::Input& input, const std::vector<double>& sample) {
    std::string bytes;
    for (const double value : sample) put_element(bytes, input, value);
    return bytes;
}

namespace {

void put_labels(std::string& bytes, const std::vector<Label>& labels) {
    put(bytes, static_cast<std::uint8_t>(labels.size()));
    for (const Label& label : labels) {
        put(bytes, label.distance);
        put(bytes, static_cast<std::uint8_t>(label.truth));
    }
}

std::string encode(const check::Model& model, const reference::Trace& trace, const Labels& labels) {
    std::string bytes;
    for (std::size_t step = 0; step < trace.size(); ++step) {
        for (std::size_t p = 0; p < model.predicates.size(); ++p)
            if (model.predicates[p].threshold.adaptation) put_labels(bytes, labels[step][p]);
        for (std::size_t n = 0; n < model.inputs.size(); ++n) {
            put(bytes, static_cast<std::uint8_t>(!trace[step][n].empty()));
            bytes += encode_sample(model.inputs[n], trace[step][n]);
        }
    }
    return bytes;
}

std::uint32_t finish_calls(const check::Model& model) {
    std::uint32_t calls = 0;
    for (const check::Monitor& monitor : model.monitors)
        if (monitor.sliding) calls = std::max(calls, monitor.horizon);
    return calls;
}

}  // namespace

std::string encode(const check::Model& model, const Request& request) {
    std::string bytes;
    put(bytes, request.spec);
    put(bytes, finish_calls(model));
    for (const bool second : {false, true}) {
        const reference::Trace& trace = second ? request.second : request.first;
        const std::string samples =
            encode(model, trace, second ? request.second_labels : request.first_labels);
        put(bytes, static_cast<std::uint32_t>(trace.size()));
        put(bytes, static_cast<std::uint32_t>(samples.size()));
        bytes += samples;
    }
    return bytes;
}

template <class T>
T Decoder::take() {
    if (bytes_.size() - position_ < sizeof(T)) throw std::out_of_range("the answer ends early");
    T value;
    std::memcpy(&value, bytes_.data() + position_, sizeof value);
    position_ += sizeof value;
    return value;
}

reference::Verdict Decoder::verdict() {
    using reference::Status;
    const auto bits = take<std::uint32_t>();
    reference::Verdict result;
    const double robustness = static_cast<double>(take<float>());
    const double lower = static_cast<double>(take<float>());
    const double upper = static_cast<double>(take<float>());
    // satisfied, violated, unknown: exactly one if it is decided, else none
    switch (bits & 15U) {
        case 8 + 1: result.status = Status::satisfied; break;
        case 8 + 2: result.status = Status::violated; break;
        case 8 + 4: result.status = Status::unknown; break;
        case 0: result.status = Status::undecided; break;
        default: throw std::out_of_range("a verdict contradicts itself");
    }
    result.final = (bits & 16U) != 0;
    if (result.status == Status::undecided) return result;
    result.lower = lower;
    result.robustness = robustness;
    result.robustness_high = std::numeric_limits<double>::quiet_NaN();
    result.upper = upper;
    return result;
}

std::optional<Observed::Why> Decoder::why() {
    if (take<std::uint8_t>() == 0) return {};
    Observed::Why why;
    const auto length = take<std::uint32_t>();
    for (std::uint32_t n = 0; n < length; ++n) why.predicate += take<char>();
    why.step = take<std::uint32_t>();
    why.robustness = take<float>();
    why.distance = take<float>();
    why.threshold = take<float>();
    why.row = take<std::uint32_t>();
    return why;
}

Observed Decoder::run(const check::Model& model, bool explains, std::size_t steps) {
    Observed result;
    for (std::size_t step = 0; step < steps; ++step) {
        auto& verdicts = result.verdicts.emplace_back();
        for (std::size_t m = 0; m < model.monitors.size(); ++m) verdicts.push_back(verdict());
        auto& whys = result.whys.emplace_back();
        for (std::size_t m = 0; explains && m < model.monitors.size(); ++m) whys.push_back(why());
        auto& telemetry = result.telemetry.emplace_back(model.predicates.size());
        for (std::size_t p = 0; p < model.predicates.size(); ++p) {
            if (model.predicates[p].name.empty()) continue;
            const auto bits = take<std::uint32_t>();
            telemetry[p].computed = (bits & 1U) != 0;
            telemetry[p].delta = static_cast<double>(take<float>());
            const auto row = take<std::uint32_t>();
            if ((bits & 2U) != 0) telemetry[p].nearest = row;
            if (!model.predicates[p].threshold.adaptation) continue;
            const float threshold = take<float>();
            if (telemetry[p].computed) telemetry[p].threshold = static_cast<double>(threshold);
        }
    }
    result.missing_steps = take<std::uint32_t>();
    for (std::uint32_t call = 0; call < finish_calls(model); ++call) {
        auto& verdicts = result.finish.emplace_back();
        for (std::size_t m = 0; m < model.monitors.size(); ++m) verdicts.push_back(verdict());
    }
    return result;
}

std::uint64_t Decoder::allocations() {
    return take<std::uint64_t>();
}

Answer Decoder::answer(const check::Model& model, bool explains, const Request& request) {
    Answer result;
    result[0] = run(model, explains, request.first.size());
    result[1] = run(model, explains, request.second.size());
    result[2] = run(model, explains, request.second.size());
    return result;
}

}  // namespace etlc::tests
