// The plan as text for others: the C++ header, a picture of the graph, the budget.
// Takes: a plan. Gives: one string per backend of backends.cpp. Keeps true: the same
// plan gives the same bytes on every machine.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plan/plan.hpp"

namespace etlc::emit {

struct Options {
    std::string name_space;    ///< of the generated code; empty: the spec's name
    std::string version;       ///< of etlc, for the head of the file
    std::string standalone;    ///< the runtime pasted in: "portable" or "host"; empty: included
    std::string targets_file;  ///< where target sets lie that are not spelled out, without folders
};

struct Backend {
    std::string_view name;     ///< of --emit
    std::string_view summary;  ///< for --help
    std::string (*emit)(const plan::Plan& plan, const Options& options);
};
const std::vector<Backend>& backends();

std::string header(const plan::Plan& plan, const Options& options);
/// What a retargetable class of this plan takes, with the numbers that the spec has.
std::string params(const plan::Plan& plan, const Options& options);
std::string dot(const plan::Plan& plan, const Options& options);
std::string report(const plan::Plan& plan, const Options& options);

}  // namespace etlc::emit
