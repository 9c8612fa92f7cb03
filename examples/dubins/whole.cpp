// whole FOLDER: runs recorded drives, .csv files of dubins_record, through the classes that etlc
// made of union.etl and whole.etl with their thresholds. Prints, for both, in how many drives some
// verdict misses a success (of `sequential`) or an alarm (of `in_order`), which the guarantee
// bounds, and in how many some verdict is wrong the other way, which is the price of the guarantee.
// It needs only the generated headers and etlmon: c++ -std=c++17 -O2 -I runtime/include -I
// FOLDER_OF_THE_HEADERS whole.cpp
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "recorded_frame.hpp"
#include "union.hpp"
#include "whole.hpp"

namespace {

/// Counts for one monitor over all drives: in how many some verdict is wrongly satisfied, or
/// wrongly not satisfied.
struct Score {
    int unfounded = 0;  // a verdict is satisfied, but the truth is not
    int missing = 0;    // the truth is satisfied, but a verdict is not

    void count(bool any_unfounded, bool any_missing) {
        unfounded += any_unfounded ? 1 : 0;
        missing += any_missing ? 1 : 0;
    }
};

struct Drive {
    bool unfounded = false;
    bool missing = false;

    void step(const etlmon::Verdict& said, bool is) {
        unfounded |= said.satisfied() && !is;
        missing |= !said.satisfied() && is;
    }
};

struct Scores {
    Score sequential;
    Score in_order;
};

/// The two formulas over the truth, written by hand.
struct Truth {
    bool been_at_a = false;
    bool been_at_b = false;
    bool sequential = false;  ///< B at the same step as A or after it
    bool in_order = true;     ///< never A at the same step as B or after it

    void step(const Frame& frame) {
        const bool at_a = frame.within(0.8, 0.8, 0.25);
        const bool at_b = frame.within(-0.8, 0.8, 0.25);
        been_at_a |= at_a;
        been_at_b |= at_b;
        sequential |= been_at_a && at_b;
        in_order &= !(been_at_b && at_a);
    }
};

template <class Monitor, class Inputs>
bool watch(const std::filesystem::path& path, Scores& scores, Truth& truth) {
    std::ifstream file(path);
    std::string row;
    std::getline(file, row);  // the names of the columns
    Monitor monitor;
    Drive sequential;
    Drive in_order;
    truth = {};
    while (std::getline(file, row)) {
        Frame frame;
        if (!read(row, frame)) return false;
        Inputs inputs;
        inputs.z = frame.z;
        const auto verdicts = monitor.step(inputs);
        truth.step(frame);
        sequential.step(verdicts.sequential, truth.sequential);
        in_order.step(verdicts.in_order, truth.in_order);
    }
    scores.sequential.count(sequential.unfounded, sequential.missing);
    scores.in_order.count(in_order.unfounded, in_order.missing);
    return file.eof();
}

void print(const char* by, int drives, int successes, int alarms, const Scores& scores) {
    // `sequential` misses a success by a verdict that is not satisfied, `in_order` an alarm by one
    // that is.
    std::printf("%s,sequential,%d,%d,%d,%d\n", by, drives, successes, scores.sequential.missing,
                scores.sequential.unfounded);
    std::printf("%s,in_order,%d,%d,%d,%d\n", by, drives, alarms, scores.in_order.unfounded,
                scores.in_order.missing);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2 || !std::filesystem::is_directory(argv[1])) {
        std::fprintf(stderr, "usage: whole FOLDER\n");
        return 2;
    }
    Scores by_union;
    Scores as_a_whole;
    int drives = 0;
    int successes = 0;
    int alarms = 0;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1])) {
        Truth truth;
        if (!watch<dubins_union::Monitor, dubins_union::Inputs>(entry.path(), by_union, truth) ||
            !watch<dubins_whole::Monitor, dubins_whole::Inputs>(entry.path(), as_a_whole, truth)) {
            std::fprintf(stderr, "whole: %s cannot be read\n", entry.path().c_str());
            return 1;
        }
        ++drives;
        successes += truth.sequential ? 1 : 0;
        alarms += truth.in_order ? 0 : 1;
    }
    std::printf("thresholds,monitor,drives,at stake,missed,wrong the other way\n");
    print("union", drives, successes, alarms, by_union);
    print("whole", drives, successes, alarms, as_a_whole);
}
