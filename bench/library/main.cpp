// Compares a step through the C interface with the same step of the evaluator behind it.
// bench_library SPEC.etl...
// Elements are random and present at every step.
#include <etlc.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "compile.hpp"
#include "diag/diag.hpp"
#include "etlmon/distance/widen.hpp"
#include "execute/evaluator.hpp"
#include "timing.hpp"

namespace {

using namespace etlc;

constexpr std::size_t kSteps = 1024;
using Steps = std::vector<std::vector<execute::Sample>>;

/// A sample in the formats of a program and of the evaluator.
struct Sample {
    std::vector<unsigned char> bytes;
    etlc_sample given;
    execute::Sample taken;
};

template <class Element, class Random, class Widen>
Sample sample_of(const check::Input& input, std::uint32_t type, Random random, Widen widen) {
    std::vector<Element> elements;
    for (std::uint32_t i = 0; i < input.dimension; ++i)
        elements.push_back(static_cast<Element>(random()));
    Sample sample;
    const auto* const first = reinterpret_cast<const unsigned char*>(elements.data());
    sample.bytes.assign(first, first + elements.size() * sizeof(Element));
    sample.given = {nullptr, input.dimension, type};
    sample.taken.present = true;
    sample.taken.values.resize(input.dimension);
    widen(elements.data(), sample.taken.values.data());
    return sample;
}

Sample random_sample(const check::Input& input, std::mt19937& random) {
    const std::uint32_t n = input.dimension;
    std::uniform_real_distribution<float> element(0, 1);
    const auto copy = [n](const auto* from, float* to) { std::copy(from, from + n, to); };
    switch (input.type) {
        case check::InputType::boolean:
            return sample_of<std::uint8_t>(
                input, ETLC_BOOL, [&] { return random() % 2; }, copy);
        case check::InputType::f16:  // from 0.125 to 1
            return sample_of<std::uint16_t>(
                input, ETLC_F16, [&] { return 0x3000 + random() % 0xc00; },
                [n](const std::uint16_t* from, float* to) { etlmon::widen_f16(from, to, n); });
        case check::InputType::i8:
            return sample_of<std::int8_t>(
                input, ETLC_I8, [&] { return static_cast<int>(random() % 256) - 128; },
                [n, &input](const std::int8_t* from, float* to) {
                    etlmon::widen_i8(from, input.scale, to, n);
                });
        case check::InputType::f32:
        case check::InputType::scalar: break;
    }
    return sample_of<float>(
        input, ETLC_F32, [&] { return element(random); }, copy);
}

/// Runs the same steps with both.
struct Trace {
    explicit Trace(const check::Model& model) {
        std::mt19937 random(1);
        for (std::size_t step = 0; step < kSteps; ++step) {
            auto& of_step = samples.emplace_back();
            for (const check::Input& input : model.inputs)
                of_step.push_back(random_sample(input, random));
        }
        for (const auto& of_step : samples) {
            taken.emplace_back();
            given.emplace_back();
            for (const Sample& sample : of_step) {
                taken.back().push_back(sample.taken);
                given.back().push_back(
                    {sample.bytes.data(), sample.given.count, sample.given.type});
            }
        }
    }
    std::vector<std::vector<Sample>> samples;
    Steps taken;
    std::vector<std::vector<etlc_sample>> given;
};

void compare(const std::string& path) {
    source::File file;
    diag::Sink sink;
    std::optional<Compiled> compiled;
    if (read_spec(path, file, sink)) compiled = compile(file, {}, {}, sink);
    if (!compiled) throw std::runtime_error(diag::render_text(file, sink));
    const Trace trace(*compiled->model);

    execute::Evaluator evaluator(compiled->plan);
    etlc_options options = ETLC_OPTIONS;
    options.path = path.c_str();
    etlc_session session = 0;
    if (etlc_open(&options, &session) != ETLC_OK) throw std::runtime_error(etlc_message());
    std::vector<etlc_verdict> verdicts(compiled->plan.monitors.size());
    const auto series = bench::measure({{"evaluator",
                                         [&] {
                                             for (const auto& step : trace.taken)
                                                 evaluator.step(step);
                                         },
                                         kSteps},
                                        {"etlc_step",
                                         [&] {
                                             for (const auto& step : trace.given)
                                                 etlc_step(session, step.data(), step.size(),
                                                           verdicts.data(), verdicts.size());
                                         },
                                         kSteps}},
                                       {});
    etlc_close(session);
    const double own = series[0].median(), through = series[1].median();
    std::printf("%-40s %9.0f %9.0f %9.0f\n", path.c_str(), own, through, through - own);
}

}  // namespace

int main(int argc, char** argv) {
    std::printf("%-40s %9s %9s %9s\n", "ns a step", "evaluator", "etlc_step", "more");
    try {
        for (int i = 1; i < argc; ++i) compare(argv[i]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
