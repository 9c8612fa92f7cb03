// Measures a whole step of the examples' monitors, and its halves: measure() is the distances and
// predicates, judge() the temporal operators; and the step of the same class with a flight recorder
// that keeps 20 steps before an alarm and 10 after it, of two incidents. Then the step of monitors
// of l2(z, z@n), for several n.
// bench_steps [--json FILE] [--rounds N]
// Cold: the first step with cold caches, as in a control loop.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "cold.hpp"
#include "earlier_1.hpp"
#include "earlier_10.hpp"
#include "earlier_90.hpp"
#include "earlier_900.hpp"
#include "median.hpp"
#include "recorded.hpp"
#include "stepped.hpp"
#include "timing.hpp"

namespace {

using nlohmann::json;

template <class Example>
json measured(bench::Effort effort) {
    using bench::kSamples;
    const auto stepped = std::make_shared<bench::SteppedExample<Example>>();
    const bench::Recorded recorded = bench::recorded(Example::kName);
    const std::vector<bench::Series> series =
        bench::measure({{"step", [=] { stepped->step(); }, kSamples},
                        {"measure", [=] { stepped->measure(); }, kSamples},
                        {"judge", [=] { stepped->judge(); }, kSamples},
                        {"step, recorded", recorded.step, kSamples}},
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
            {"state_bytes", Example::Monitor::kStateBytes},
            {"recorded_ns", series[3].median()},
            {"recorded_to_step", bench::ratio(series[3], series[0])},
            {"recorded_state_bytes", recorded.state_bytes}};
}

void print(const json& row) {
    std::printf("%-40s %9.1f %9.1f %9.1f %4.0f %9.0f %7.0f %9.1f %6.2f %7.0f\n",
                row["example"].get<std::string>().c_str(), row["step_ns"].get<double>(),
                row["measure_ns"].get<double>(), row["judge_ns"].get<double>(),
                row["spread_percent"].get<double>(), row["cold_step_ns"].get<double>(),
                row["state_bytes"].get<double>(), row["recorded_ns"].get<double>(),
                row["recorded_to_step"].get<double>(), row["recorded_state_bytes"].get<double>());
    std::fflush(stdout);
}

/// A monitor of l2(z, z@n), which has seen n samples.
template <class OfEarlier, class Inputs>
struct Earlier {
    using Monitor = OfEarlier;
    std::uint16_t z[384];
    explicit Earlier(bench::Random& random) {
        for (auto& x : z) x = static_cast<std::uint16_t>(0x3c00U + random() % 0x800U);  // in [1, 4)
    }
    Inputs inputs() const { return {z}; }
};

using Earlier1 = Earlier<earlier_1::Monitor, earlier_1::Inputs>;
using Earlier10 = Earlier<earlier_10::Monitor, earlier_10::Inputs>;
using Earlier90 = Earlier<earlier_90::Monitor, earlier_90::Inputs>;
using Earlier900 = Earlier<earlier_900::Monitor, earlier_900::Inputs>;

template <class Example>
bench::Routine stepped(std::vector<double>& cold, int rounds) {
    const auto stepped = std::make_shared<bench::SteppedExample<Example>>();
    for (std::size_t i = 0; i < 1000; i += bench::kSamples) stepped->step();
    for (int round = 0; round < rounds; ++round)
        cold.push_back(bench::cold_call([&] {
            const auto verdicts = stepped->monitor.step(stepped->inputs[0]);
            asm volatile("" : : "r"(&verdicts) : "memory");
        }));
    return {"", [=] { stepped->step(); }, bench::kSamples};
}

/// Measures the monitors in turns.
json measure_earlier(bench::Effort effort) {
    std::vector<std::vector<double>> cold(4);
    const std::vector<bench::Series> series = bench::measure(
        {stepped<Earlier1>(cold[0], effort.rounds), stepped<Earlier10>(cold[1], effort.rounds),
         stepped<Earlier90>(cold[2], effort.rounds), stepped<Earlier900>(cold[3], effort.rounds)},
        effort);
    const std::uint32_t steps[] = {1, 10, 90, 900};
    const std::uint64_t bytes[] = {Earlier1::Monitor::kStateBytes, Earlier10::Monitor::kStateBytes,
                                   Earlier90::Monitor::kStateBytes,
                                   Earlier900::Monitor::kStateBytes};
    json all = json::array();
    std::printf("%-40s %9s %4s %9s %9s\n", "l2(z, z@n), 384 float16: n", "step, ns", "+-%",
                "cold, ns", "state");
    for (std::size_t i = 0; i < series.size(); ++i) {
        std::printf("%-40u %9.1f %4.0f %9.0f %9llu\n", steps[i], series[i].median(),
                    100 * series[i].spread(), bench::median(cold[i]),
                    static_cast<unsigned long long>(bytes[i]));
        all.push_back({{"steps_ago", steps[i]},
                       {"step_ns", series[i].median()},
                       {"cold_step_ns", bench::median(cold[i])},
                       {"state_bytes", bytes[i]}});
    }
    return all;
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

    const char* const line = "%-40s %9s %9s %9s %4s %9s %7s %9s %6s %7s\n";
    std::printf(line, "example", "step", "measure", "judge", "+-", "cold step", "state", "recorded",
                "/ step", "state");
    std::printf(line, "", "ns", "ns", "ns", "%", "ns", "bytes", "ns", "", "bytes");
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
    for (json& row : measure_earlier(effort)) all.push_back(std::move(row));
    if (file.empty()) return 0;
    std::ofstream out(file);
    out << all.dump(2) << '\n';
    return out.flush() ? 0 : 1;
}
