// Compares temporal operators of generated monitors, on given robustness values, with hand-written
// code. bench_temporal [--operators] [--json FILE] [--only TEXT] [--rounds N]: prints the table of
// monitors, or that of the runtime's operators alone.
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
            row<Count50>(),
            row<Mean50>(),
            row<Change10>(),
            row<Chain24>(),
            row<Until24>(),
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

/// Prints a figure, or blanks if there is none.
std::string figure(const json& row, const char* name, int decimals) {
    char text[32] = "-";
    if (row.contains(name))
        std::snprintf(text, sizeof text, "%.*f", decimals, row[name].get<double>());
    return text;
}

struct Column {
    const char* head;  ///< two lines
    const char* below;
    const char* key;  ///< of the figure
    int width, decimals;
};
constexpr Column kColumns[] = {
    {"plain", "ns", "plain_ns", 7, 2},
    {"ready", "ns", "ready_ns", 7, 2},
    {"ready/", "plain", "ready_to_plain", 6, 2},
    {"judge", "ns", "judged_ns", 7, 2},
    {"why/", "judge", "why_to_judged", 6, 2},
    {"step", "ns", "robustness_ns", 7, 2},
    {"step/", "plain", "robustness_to_plain", 6, 2},
    {"verd/", "step", "verdict_to_robustness", 6, 2},
    {"why/", "verd", "why_step_to_verdict", 6, 2},
    {"rescan/", "step", "rescan_to_robustness", 8, 1},
    {"| called", "plain", "plain_called_ns", 9, 2},
    {"ready", "ns", "ready_called_ns", 7, 2},
    {"ready/", "plain", "ready_called_to_plain", 6, 2},
    {"judge", "ns", "judged_called_ns", 7, 2},
    {"why/", "judge", "why_to_judged_called", 6, 2},
    {"step", "ns", "robustness_called_ns", 7, 2},
    {"step/", "plain", "robustness_called_to_plain", 6, 2},
    {"verdict", "ns", "verdict_called_ns", 8, 2},
    {"why/", "verd", "why_step_to_verdict_called", 6, 2},
    {"+-", "%", "spread_percent", 3, 0},
    {"copilot/", "step", "copilot_to_robustness_called", 9, 1},
    {"| worst", "ns", "worst_step_ns", 8, 0},
    {"state", "bytes", "state_bytes", 8, 0},
    {"with", "why", "why_state_bytes", 8, 0},
    {"ops", "", "operations", 6, 0},
};

void print_head() {
    for (const char* Column::*line : {&Column::head, &Column::below}) {
        std::printf("%-36s", line == &Column::head ? "formula" : "");
        for (const Column& column : kColumns) std::printf(" %*s", column.width, column.*line);
        std::printf("\n");
    }
}

void print(const json& row) {
    std::printf("%-36s", row["formula"].get<std::string>().c_str());
    for (const Column& column : kColumns)
        std::printf(" %*s", column.width, figure(row, column.key, column.decimals).c_str());
    std::printf("\n");
    std::fflush(stdout);
}

json measured(const Row& row, bench::Effort effort) {
    std::vector<Routine> routines{row.judge.loop,   row.judge.call,  row.judged.loop,
                                  row.judged.call,  row.rho.loop,    row.rho.call,
                                  row.verdict.loop, row.verdict.call};
    std::size_t next = routines.size();
    for (const std::optional<Routine>& more :
         {row.why.loop, row.why.call, row.why_step.loop, row.why_step.call, row.plain.loop,
          row.plain.call, row.rescan, row.copilot})
        if (more) routines.push_back(*more);
    const std::vector<Series> series = bench::measure(routines, effort);
    const bench::Ways<Series> ready{series[0], series[1]}, judged{series[2], series[3]},
        rho{series[4], series[5]}, verdict{series[6], series[7]};
    json result{{"formula", row.title},
                {"ready_ns", ready.loop.median()},
                {"ready_called_ns", ready.call.median()},
                {"judged_ns", judged.loop.median()},
                {"judged_called_ns", judged.call.median()},
                {"robustness_ns", rho.loop.median()},
                {"robustness_called_ns", rho.call.median()},
                {"verdict_ns", verdict.loop.median()},
                {"verdict_called_ns", verdict.call.median()},
                {"spread_percent", 100 * verdict.call.spread()},
                {"verdict_to_robustness", bench::ratio(verdict.loop, rho.loop)},
                {"state_bytes", row.state_bytes},
                {"operations", row.operations},
                {"worst_step_ns", row.worst()}};
    if (row.why.loop) {
        const bench::Ways<Series> why{series[next], series[next + 1]},
            step{series[next + 2], series[next + 3]};
        next += 4;
        result["why_to_judged"] = bench::ratio(why.loop, judged.loop);
        result["why_called_ns"] = why.call.median();
        result["why_to_judged_called"] = bench::ratio(why.call, judged.call);
        result["why_step_to_verdict"] = bench::ratio(step.loop, verdict.loop);
        result["why_step_to_verdict_called"] = bench::ratio(step.call, verdict.call);
        result["why_state_bytes"] = row.why_state_bytes;
    }
    if (row.plain.loop) {
        const bench::Ways<Series> plain{series[next], series[next + 1]};
        next += 2;
        result["plain_ns"] = plain.loop.median();
        result["plain_called_ns"] = plain.call.median();
        result["ready_to_plain"] = bench::ratio(ready.loop, plain.loop);
        result["ready_called_to_plain"] = bench::ratio(ready.call, plain.call);
        result["robustness_to_plain"] = bench::ratio(rho.loop, plain.loop);
        result["robustness_called_to_plain"] = bench::ratio(rho.call, plain.call);
    }
    if (row.rescan) {
        result["rescan_ns"] = series[next].median();
        result["rescan_to_robustness"] = bench::ratio(series[next++], rho.loop);
    }
    if (row.copilot) {
        result["copilot_ns"] = series[next].median();
        result["copilot_to_robustness_called"] = bench::ratio(series[next], rho.call);
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
    app.add_flag("--operators", operators,
                 "the operators of the runtime by themselves instead of monitors");
    app.add_option("--json", file, "writes the figures there too");
    app.add_option("--rounds", effort.rounds, "rounds; figures are medians over them")
        ->check(CLI::PositiveNumber);
    CLI11_PARSE(app, argc, argv);

    const json all =
        operators ? bench::measure_operators(only, effort) : measure_monitors(only, effort);
    if (file.empty()) return 0;
    std::ofstream out(file);
    out << all.dump(2) << '\n';
    return out.flush() ? 0 : 1;
}
