// watch FOLDER: runs recorded drives, .csv files of dubins_record, through the class that etlc made
// of paper.etl with its thresholds. Prints per monitor the number of episodes whose last verdict
// agrees with the truth from the car's position. It needs only the generated header and etlmon: c++
// -std=c++17 -O2 -I runtime/include -I FOLDER_OF_THE_HEADER watch.cpp
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "paper.hpp"
#include "recorded_frame.hpp"

namespace {

/// The four formulas over the truth, written by hand.
struct Truth {
    bool reached = false;
    bool avoided = true;
    bool in_order = false;

    void step(const Frame& frame) {
        reached |= frame.within(0.8, 0.8, 0.25);
        avoided &= !frame.within(0.8, -0.8, 0.5);
        in_order |= reached && frame.within(-0.8, 0.8, 0.25);
    }
};

struct Score {
    const char* name;
    int satisfied = 0;
    int agreeing = 0;

    void count(const etlmon::Verdict& said, bool is) {
        satisfied += is ? 1 : 0;
        agreeing += said.satisfied() == is ? 1 : 0;
    }
};

std::array<Score, 8> scores = {{{"reach_f1"},
                                {"avoid_f1"},
                                {"reach_avoid_f1"},
                                {"sequential_f1"},
                                {"reach_cp"},
                                {"avoid_cp"},
                                {"reach_avoid_cp"},
                                {"sequential_cp"}}};

bool watch(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string row;
    std::getline(file, row);  // the names of the columns
    dubins_paper::Monitor monitor;
    dubins_paper::Verdicts verdicts;
    Truth truth;
    while (std::getline(file, row)) {
        Frame frame;
        if (!read(row, frame)) return false;
        dubins_paper::Inputs inputs;
        inputs.z = frame.z;
        verdicts = monitor.step(inputs);
        truth.step(frame);
    }
    const bool both = truth.reached && truth.avoided;
    scores[0].count(verdicts.reach_f1, truth.reached);
    scores[1].count(verdicts.avoid_f1, truth.avoided);
    scores[2].count(verdicts.reach_avoid_f1, both);
    scores[3].count(verdicts.sequential_f1, truth.in_order);
    scores[4].count(verdicts.reach_cp, truth.reached);
    scores[5].count(verdicts.avoid_cp, truth.avoided);
    scores[6].count(verdicts.reach_avoid_cp, both);
    scores[7].count(verdicts.sequential_cp, truth.in_order);
    return file.eof();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2 || !std::filesystem::is_directory(argv[1])) {
        std::fprintf(stderr, "usage: watch FOLDER\n");
        return 2;
    }
    int drives = 0;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1])) {
        ++drives;
        if (watch(entry.path())) continue;
        std::fprintf(stderr, "watch: %s cannot be read\n", entry.path().c_str());
        return 1;
    }
    std::printf("monitor         episodes agree  truly satisfied\n");
    for (const Score& score : scores)
        std::printf("%-14s  %5d of %5d  %15d\n", score.name, score.agreeing, drives,
                    score.satisfied);
}
