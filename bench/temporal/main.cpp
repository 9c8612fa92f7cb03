// Temporal operators of generated monitors, on robustness values that are ready, against what one would write by hand.
// bench_temporal [--operators] [--json FILE] [--only TEXT] [--rounds N]: prints the table of monitors, or that of the
// runtime's operators by themselves.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "operators.hpp"
#include "row.hpp"

namespace {

using bench::Routine;
using bench::Row;
using bench::Series;
using nlohmann::json;

std::vector<Row> rows() {
    using namespace bench;
    return {row<One>(),
            row<Two>(),
            row<Three>(),
            row<Invariant>(),
            row<Eventually50>(),
            row<Always1000>(),
            row<Until100>(),
            row<Response50>(),
            row<Sequence>(),
            row<Responses>(),
            row<AlwaysEventually50>(),
            row<EventuallyAlways1000>(),
            row<AlwaysUntil100>(),
            row<Nested>(),
            row<NestedBounds>(),
            row<Eventually100000>(),
            row<Until10000>(),
            row<SmallMachine>(),
            row<LargeMachine>()};
}

/// A figure, or blanks where there is none.
std::string figure(const json& row, const char* name, int decimals) {
    char text[32] = "-";
    if (row.contains(name)) std::snprintf(text, sizeof text, "%.*f", decimals, row[name].get<double>());
    return text;
}

void print_head() {
    std::printf("%-37s %7s %7s %7s %5s %6s %6s %7s %8s %7s %7s %7s %8s %7s\n", "formula", "plain", "rho", "verdict",
                "+-", "rho/", "verd/", "rescan/", "copilot/", "plain,", "verd,", "worst", "state", "ops");
    std::printf("%-37s %7s %7s %7s %5s %6s %6s %7s %8s %7s %7s %7s %8s %7s\n", "", "ns", "ns", "ns", "%", "plain",
                "rho", "rho", "call ns", "call ns", "ns", "bytes", "");
}

void print(const json& row) {
    std::printf("%-37s %7s %7s %7s %5s %6s %6s %7s %8s %7s %7s %7s %8s %7s\n",
                row["formula"].get<std::string>().c_str(), figure(row, "plain_ns", 2).c_str(),
                figure(row, "robustness_ns", 2).c_str(), figure(row, "verdict_ns", 2).c_str(),
                figure(row, "spread_percent", 0).c_str(), figure(row, "robustness_to_plain", 2).c_str(),
                figure(row, "verdict_to_robustness", 2).c_str(), figure(row, "rescan_to_robustness", 1).c_str(),
                figure(row, "copilot_to_robustness", 1).c_str(), figure(row, "plain_called_ns", 2).c_str(),
                figure(row, "verdict_called_ns", 2).c_str(), figure(row, "worst_step_ns", 0).c_str(),
                figure(row, "state_bytes", 0).c_str(), figure(row, "operations", 0).c_str());
    std::fflush(stdout);
}

json measured(const Row& row, bench::Effort effort) {
    std::vector<Routine> routines{row.rho, row.verdict, row.called};
    for (const std::optional<Routine>& more : {row.plain, row.plain_called, row.rescan, row.copilot})
        if (more) routines.push_back(*more);
    const std::vector<Series> series = bench::measure(routines, effort);
    const Series& rho = series[0];
    json result{{"formula", row.title},
                {"robustness_ns", rho.median()},
                {"verdict_ns", series[1].median()},
                {"spread_percent", 100 * series[1].spread()},
                {"verdict_to_robustness", bench::ratio(series[1], rho)},
                {"verdict_called_ns", series[2].median()},
                {"state_bytes", row.state_bytes},
                {"operations", row.operations},
                {"worst_step_ns", row.worst()}};
    std::size_t next = 3;
    if (row.plain) {
        result["plain_ns"] = series[next].median();
        result["robustness_to_plain"] = bench::ratio(rho, series[next++]);
        result["plain_called_ns"] = series[next].median();
        result["verdict_to_plain_called"] = bench::ratio(series[2], series[next++]);
    }
    if (row.rescan) {
        result["rescan_ns"] = series[next].median();
        result["rescan_to_robustness"] = bench::ratio(series[next++], rho);
    }
    if (row.copilot) {
        result["copilot_ns"] = series[next].median();
        result["copilot_to_robustness"] = bench::ratio(series[next], rho);
    }
    return result;
}

json measure_monitors(const std::string& only, bench::Effort effort) {
    print_head();
    json all = json::array();
    for (const Row& row : rows()) {
        if (row.title.find(only) == std::string::npos) continue;
        all.push_back(measured(row, effort));
        print(all.back());
    }
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    std::string only;
    std::string file;
    bool operators = false;
    bench::Effort effort;
    CLI::App app{"What a step of temporal operators costs, against loops written by hand."};
    app.add_option("--only", only, "the formulas whose text contains this");
    app.add_flag("--operators", operators, "the operators of the runtime by themselves instead of monitors");
    app.add_option("--json", file, "writes the figures there too");
    app.add_option("--rounds", effort.rounds, "rounds; figures are medians over them")->check(CLI::PositiveNumber);
    CLI11_PARSE(app, argc, argv);

    const json all = operators ? bench::measure_operators(only, effort) : measure_monitors(only, effort);
    if (file.empty()) return 0;
    std::ofstream out(file);
    out << all.dump(2) << '\n';
    return out.flush() ? 0 : 1;
}
