// Prints the robustness of two monitors at one step.
#include <cstdio>

#include "guard.hpp"
#include "reach.hpp"

int main() {
    const float z[2] = {0.5F, 0.0F};
    reach::Inputs place;
    place.z = z;
    reach::Monitor reach_monitor;
    const float reached = reach_monitor.step(place).reached.robustness;

    watch::Inputs motion;
    motion.speed = 2.0F;
    watch::Monitor guard_monitor;
    const float limit = guard_monitor.step(motion).limit.robustness;

    std::printf("reached %g limit %g\n", static_cast<double>(reached), static_cast<double>(limit));
}
