// compare FIRMWARE.txt HOST.txt: compares two outputs of examples/firmware_loop, verdict by
// verdict. The kernels add in different orders, so a robustness from the one long distance may
// differ by twice its rounding bound, one from a projection by a few last places, and a status if
// the robustness is that small. Everything else is equal to the bit.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "etlmon/hosted/error_bounds.hpp"

namespace {

float number(std::uint32_t bits) {
    float x = 0;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

/// Returns the greatest difference of two robustness values of this monitor class.
double bound(const std::string& name, float robustness) {
    constexpr double kThreshold = 22.5;  // of the predicate of grasp
    constexpr double kProjected = 1e-5;  // sums of 12 products below 1, then short distances
    if (name == "sort" && std::isfinite(robustness)) return kProjected;
    if (name != "grasp" || !std::isfinite(robustness)) return 0;
    return 2 * etlmon::rounding_bound(etlmon::MetricId::l2, 384,
                                      kThreshold + std::abs(double{robustness}));
}

bool agree(const std::string& name, const std::vector<std::uint32_t>& a,
           const std::vector<std::uint32_t>& b) {
    if (a.size() != b.size() || a.empty() || a[0] != b[0]) return false;
    for (std::size_t i = 1; i + 3 < a.size(); i += 4) {
        bool close = true;
        for (std::size_t k = i + 1; k < i + 4; ++k) {
            const float x = number(a[k]), y = number(b[k]);
            if (a[k] != b[k] && !(std::abs(double{x} - double{y}) <= bound(name, x))) return false;
            close &= !(std::abs(x) > bound(name, x));
        }
        if (a[i] != b[i] && !close) return false;
    }
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    std::ifstream one(argv[1]), two(argv[2]);
    int lines = 0, different = 0;
    for (std::string x, y; std::getline(one, x) && std::getline(two, y); ++lines) {
        if (x.rfind("instructions", 0) == 0) break;
        std::istringstream xs(x), ys(y);
        std::string name, other;
        xs >> name >> std::hex, ys >> other >> std::hex;
        std::vector<std::uint32_t> a, b;
        for (std::uint32_t v = 0; xs >> v;) a.push_back(v);
        for (std::uint32_t v = 0; ys >> v;) b.push_back(v);
        different += a != b;
        if (name == other && agree(name, a, b)) continue;
        std::printf("%s\n%s\n", x.c_str(), y.c_str());
        return 1;
    }
    std::printf("%d steps agree, %d of them not to the bit\n", lines, different);
    return lines >= 17500 ? 0 : 1;
}
