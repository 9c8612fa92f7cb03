// A monitor with its targets in a file.
#include <cstdio>

#include "etlmon/hosted/mapped_targets.hpp"
#include "reach.hpp"

int main() {
    const etlmon::MappedTargets<reach::Targets> file(REACH_TARGETS);
    const float z[2] = {0.5F, 0.0F};
    reach::Inputs place;
    place.z = z;
    reach::Monitor monitor(file.targets());
    std::printf("%s: reached %g\n", file.message(),
                static_cast<double>(monitor.step(place).reached.robustness));
}
