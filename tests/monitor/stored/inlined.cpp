// The class with its target sets in the header: compiled once, beside every build of the other one.
#include "inlined.hpp"

#include "run.hpp"

std::vector<std::uint32_t> run_inlined(const std::vector<trial::Sample>& wide,
                                       const std::vector<trial::Sample>& middle,
                                       const std::vector<trial::Sample>& narrow) {
    inlined::Monitor monitor;
    return trial::run<inlined::Inputs>(monitor, wide, middle, narrow);
}
