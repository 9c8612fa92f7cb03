// Steps the monitor of example.etl through the four steps of the paper's Example 2 and prints the
// verdict after each.
#include <cstdio>

#include "example.hpp"  // generated from example.etl

namespace {

constexpr float kEpsilon = 0.409F;  // the threshold in example.etl

// The embeddings are 0.327, 0.374, 0.403 and 0.427 away from the nearest target, along (0.6, 0.8)
// or (-0.6, 0.8).
constexpr float kEmbeddings[][2] = {
    {0.1962F, 0.2616F},
    {0.2244F, 0.2992F},
    {1 - 0.2418F, 0.3224F},
    {1 - 0.2562F, 0.3416F},
};

const char* word(const etlmon::Verdict& verdict) {
    return verdict.satisfied() ? "satisfied" : "violated";
}

}  // namespace

int main() {
    example::Monitor monitor;
    std::printf(
        "step  distance  target  near_goal  G near_goal  verdict    lower   upper  final\n");
    for (int step = 0; step < 4; ++step) {
        const etlmon::Verdict stays = monitor.step({kEmbeddings[step]}).stays;
        const float distance = monitor.distance_near_goal();
        std::printf("%4d  %8.3f  %6u  %9.3f  %11.3f  %-9s  %5.3g  %6.3f  %s\n", step,
                    static_cast<double>(distance), monitor.nearest_near_goal(),
                    static_cast<double>(kEpsilon - distance), static_cast<double>(stays.robustness),
                    word(stays), static_cast<double>(stays.lower), static_cast<double>(stays.upper),
                    stays.final() ? "yes" : "no");
    }
}
