// The cost of replaceable numbers: a whole step of the examples' retargetable classes beside that
// of the plain ones, and a change of parameters.
// bench_retargetable [--rounds N]
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <vector>

#include "of_short_rows.hpp"
#include "retargetable.hpp"
#include "stepped.hpp"
#include "timing.hpp"

namespace {

template <class Example>
void print(bench::Effort effort) {
    using bench::kSamples;
    const auto plain = std::make_shared<bench::SteppedExample<Example>>();
    const bench::Retargetable other = bench::retargetable(Example::kName);
    const std::vector<bench::Series> series =
        bench::measure({{"step", [=] { plain->step(); }, kSamples},
                        {"step, retargetable", other.step, kSamples},
                        {"retarget", other.retarget, 1}},
                       effort);
    std::printf("%-40s %9.1f %12.1f %6.2f %9.0f %6zu %6zu %7zu\n", Example::kName,
                series[0].median(), series[1].median(), bench::ratio(series[1], series[0]),
                series[2].median(), Example::Monitor::kStateBytes, other.state_bytes,
                other.params_bytes);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    bench::Effort effort;
    CLI::App app{"What a step of a retargetable class costs."};
    app.add_option("--rounds", effort.rounds, "rounds; figures are medians over them")
        ->check(CLI::PositiveNumber);
    CLI11_PARSE(app, argc, argv);
    std::printf("%-40s %9s %12s %6s %9s %6s %6s %7s\n", "example", "step, ns", "retargetable",
                "ratio", "retarget", "state", "state", "params");
    print<bench::PaperExample>(effort);
    print<bench::Dubins>(effort);
    print<bench::Dock>(effort);
    print<bench::Hover>(effort);
    print<bench::Belt>(effort);
    print<bench::Gauge>(effort);
    print<bench::Grasp>(effort);
    print<bench::ShortRows>(effort);
}
