// A step through the C interface beside the same step of the evaluator that is behind it.
// bench_library SPEC.etl...
// Inputs are embeddings and scalars of float32, with random elements.
#include <etlc.h>

#include <cstdio>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "diag/render.hpp"
#include "library/open.hpp"
#include "plan/evaluate/evaluator.hpp"
#include "timing.hpp"

namespace {

using namespace etlc;

constexpr std::size_t kSteps = 1024;
using Steps = std::vector<std::vector<plan::Sample>>;

Steps random_steps(const check::Model& model) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> element(0, 1);
    Steps steps(kSteps);
    for (auto& samples : steps)
        for (const check::Input& input : model.inputs) {
            if (input.type != check::InputType::f32 && input.type != check::InputType::scalar)
                throw std::runtime_error("input '" + input.name + "' is not of float32");
            plan::Sample& sample = samples.emplace_back();
            sample.present = true;
            for (std::uint32_t i = 0; i < input.dimension; ++i)
                sample.values.push_back(element(random));
        }
    return steps;
}

/// The same, as the C interface takes them.
std::vector<std::vector<etlc_sample>> given(const Steps& steps) {
    std::vector<std::vector<etlc_sample>> all;
    for (const auto& samples : steps) {
        auto& step = all.emplace_back();
        for (const plan::Sample& sample : samples)
            step.push_back(
                {sample.values.data(), static_cast<std::uint32_t>(sample.values.size()), ETLC_F32});
    }
    return all;
}

void compare(const std::string& path) {
    source::File file;
    diag::Sink sink;
    std::optional<pipeline::Compiled> compiled;
    if (library::read_spec(path, file, sink)) compiled = library::compile(file, {}, {}, sink);
    if (!compiled) throw std::runtime_error(diag::render_text(file, sink));
    const Steps steps = random_steps(*compiled->model);
    const auto samples = given(steps);

    plan::Evaluator evaluator(compiled->plan);
    etlc_options options = ETLC_OPTIONS;
    options.path = path.c_str();
    etlc_session session = 0;
    if (etlc_open(&options, &session) != ETLC_OK) throw std::runtime_error(etlc_message());
    std::vector<etlc_verdict> verdicts(compiled->plan.monitors.size());
    const auto series = bench::measure({{"evaluator",
                                         [&] {
                                             for (const auto& step : steps) evaluator.step(step);
                                         },
                                         kSteps},
                                        {"etlc_step",
                                         [&] {
                                             for (const auto& step : samples)
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
