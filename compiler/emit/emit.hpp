// Back ends: the C++ header, the graph as a picture, the budget. Each turns a plan into a string,
// with the same bytes on every machine.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plan/plan.hpp"

namespace etlc::emit {

struct Options {
    std::string name_space;    ///< namespace of the generated code; empty: the spec's name
    std::string version;       ///< of etlc, for the head of the file
    std::string standalone;    ///< paste the runtime, "portable" or "host"; empty: include it
    std::string targets_file;  ///< file of target sets outside the header, without folders
};

struct Backend {
    std::string_view name;     ///< of --emit
    std::string_view summary;  ///< for --help
    std::string (*emit)(const plan::Plan& plan, const Options& options);
};
const std::vector<Backend>& backends();

std::string header(const plan::Plan& plan, const Options& options);
/// Returns the parameters of a retargetable class of this plan, with the numbers of the spec.
std::string params(const plan::Plan& plan, const Options& options);
std::string dot(const plan::Plan& plan, const Options& options);
std::string report(const plan::Plan& plan, const Options& options);

}  // namespace etlc::emit
