// A whole step of the examples' monitors, and its split: measure() is the distances and what
// predicates make of them, judge() the temporal operators. bench_steps [--json FILE] [--rounds N]
// Cold: the first step after something else went through the caches, which is how a control loop
// finds them.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "cold.hpp"
#include "examples.hpp"
#include "median.hpp"
#include "timing.hpp"

namespace {

using nlohmann::json;

constexpr std::size_t kSamples = 64;  ///< in turns; small enough for the second-level cache

template <class Example>
struct Stepped {
    using Monitor = typename Example::Monitor;
    using Atoms = typename Monitor::Atoms;

    std::vector<Example> examples;
    std::vector<decltype(std::declval<Example>().inputs())> inputs;
    std::vector<Atoms> atoms;
    Monitor monitor;

    Stepped() {
        bench::Random random(7);
        for (std::size_t i = 0; i < kSamples; ++i) examples.emplace_back(random);
        for (const Example& example : examples) inputs.push_back(example.inputs());
        monitor.reset();
        for (const auto& in : inputs) atoms.push_back(monitor.measure(in));
    }
    void step() {
        for (const auto& in : inputs) keep(monitor.step(in));
    }
    void measure() {
        for (const auto& in : inputs) keep(monitor.measure(in));
    }
    void judge() {
        for (const Atoms& now : atoms) keep(monitor.judge(now));
    }

private:
    template <class T>
    static void keep(const T& value) {
        asm volatile("" : : "r"(&value) : "memory");
    }
};

template <class Example>
json measured(bench::Effort effort) {
    const auto stepped = std::make_shared<Stepped<Example>>();
    const std::vector<bench::Series> series =
        bench::measure({{"step", [=] { stepped->step(); }, kSamples},
                        {"measure", [=] { stepped->measure(); }, kSamples},
                        {"judge", [=] { stepped->judge(); }, kSamples}},
                       effort);
    std::size_t next = 0;
    std::vector<double> cold;
    for (int round = 0; round < effort.rounds; ++round) {
        cold.push_back(bench::cold_call([&] {
            const auto verdicts = stepped->monitor.step(stepped->inputs[next++ % kSamples]);
            asm volatile("" : : "r"(&verdicts) : "memory");
        }));
    }
    return {{"example", Example::kName},
            {"step_ns", series[0].median()},
            {"measure_ns", series[1].median()},
            {"judge_ns", series[2].median()},
            {"spread_percent", 100 * series[0].spread()},
            {"cold_step_ns", bench::median(cold)},
            {"state_bytes", Example::Monitor::kStateBytes}};
}

void print(const json& row) {
    std::printf("%-40s %9.1f %9.1f %9.1f %4.0f %9.0f %7.0f\n",
                row["example"].get<std::string>().c_str(), row["step_ns"].get<double>(),
                row["measure_ns"].get<double>(), row["judge_ns"].get<double>(),
                row["spread_percent"].get<double>(), row["cold_step_ns"].get<double>(),
                row["state_bytes"].get<double>());
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    std::string file;
    bench::Effort effort;
    CLI::App app{"What a whole step of the examples' monitors costs."};
    app.add_option("--json", file, "writes the figures there too");
    app.add_option("--rounds", effort.rounds, "rounds; figures are medians over them")
        ->check(CLI::PositiveNumber);
    CLI11_PARSE(app, argc, argv);

    std::printf("%-40s %9s %9s %9s %4s %9s %7s\n%-40s %9s %9s %9s %4s %9s %7s\n", "example", "step",
                "measure", "judge", "+-", "cold step", "state", "", "ns", "ns", "ns", "%", "ns",
                "bytes");
    json all = json::array();
    const auto add = [&](json row) {
        print(row);
        all.push_back(std::move(row));
    };
    add(measured<bench::PaperExample>(effort));
    add(measured<bench::Dubins>(effort));
    add(measured<bench::Dock>(effort));
    add(measured<bench::Hover>(effort));
    add(measured<bench::Belt>(effort));
    add(measured<bench::Gauge>(effort));
    add(measured<bench::Grasp>(effort));
    if (file.empty()) return 0;
    std::ofstream out(file);
    out << all.dump(2) << '\n';
    return out.flush() ? 0 : 1;
}
