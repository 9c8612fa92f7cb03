// A monitor with its numbers in a file.
#include <cstdio>

#include "reach.hpp"

int main() {
    alignas(reach::Params::kAlignment) static unsigned char page[reach::Params::kSize];
    std::FILE* const file = std::fopen(REACH_PARAMS, "rb");
    if (file == nullptr) return 1;
    const std::size_t size = std::fread(page, 1, sizeof page, file);
    std::fclose(file);
    const float z[2] = {0.5F, 0.0F};
    reach::Inputs place;
    place.z = z;
    reach::Monitor monitor;
    const etlmon::ParamsState state = monitor.retarget(page, size, etlmon::Past::kept);
    std::printf("%s: reached %g\n", etlmon::words(state),
                static_cast<double>(monitor.step(place).reached.robustness));
}
