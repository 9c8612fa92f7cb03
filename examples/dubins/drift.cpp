// drift FOLDER: runs recorded drives, in the order of their names, as dubins_record --sagging
// writes them, through the class that etlc made of drift.etl with its thresholds. Every step gets
// its label two seconds late. Prints, for each tenth of the drives, how many of the frames inside A
// either predicate missed, and how many outside it took for A. It needs only the generated header
// and etlmon: c++ -std=c++17 -O2 -I runtime/include -I FOLDER_OF_THE_HEADER drift.cpp
// header and etlmon: c++ -std=c++17 -O2 -I runtime/include -I FOLDER_OF_THE_HEADER drift.cpp
#include <algorithm>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "drift.hpp"
#include "recorded_frame.hpp"

namespace {

constexpr std::size_t kLateness = 40;  // steps of 50 ms
constexpr std::size_t kParts = 10;

/// Counts frames inside A and outside, and the misjudged ones among them.
struct Counts {
    int inside = 0;
    int outside = 0;
    int missed_fixed = 0;
    int missed_adaptive = 0;
    int false_fixed = 0;
    int false_adaptive = 0;

    void add(bool truth, bool fixed, bool adaptive) {
        inside += truth ? 1 : 0;
        outside += truth ? 0 : 1;
        missed_fixed += truth && !fixed ? 1 : 0;
        missed_adaptive += truth && !adaptive ? 1 : 0;
        false_fixed += !truth && fixed ? 1 : 0;
        false_adaptive += !truth && adaptive ? 1 : 0;
    }
};

struct Label {
    float distance;
    bool truth;
};

class Watch {
public:
    bool drive(const std::filesystem::path& path, Counts& counts) {
        std::ifstream file(path);
        std::string row;
        std::getline(file, row);  // the names of the columns
        monitor_.reset();         // a new drive; the threshold stays
        while (std::getline(file, row)) {
            Frame frame;
            if (!read(row, frame)) return false;
            step(frame, counts);
        }
        return file.eof();
    }

    float threshold() const { return monitor_.threshold_a_adaptive(); }
    int labelled() const { return labelled_; }
    int missed() const { return missed_; }

private:
    void step(const Frame& frame, Counts& counts) {
        const bool inside = frame.within(0.8, 0.8, 0.25);
        const float threshold = monitor_.threshold_a_adaptive();
        dubins_drift::Inputs inputs;
        inputs.z = frame.z;
        monitor_.step(inputs);
        const float distance = monitor_.distance_a_adaptive();
        counts.add(inside,
                   monitor_.distance_a_fixed() <= dubins_drift::Monitor::threshold_a_fixed(),
                   distance <= threshold);
        labels_.push_back({distance, inside});
        if (labels_.size() <= kLateness) return;
        const Label label = labels_.front();
        labels_.pop_front();
        labelled_ += label.truth ? 1 : 0;
        missed_ += label.truth && label.distance > monitor_.threshold_a_adaptive() ? 1 : 0;
        monitor_.observe_a_adaptive(label.distance, label.truth);
    }

    dubins_drift::Monitor monitor_;
    std::deque<Label> labels_;  // kept by the labelling program, not by the monitor
    int labelled_ = 0;          // frames inside A
    int missed_ = 0;  // by the threshold at the time of the label, which the guarantee is about
};

double percent(int part, int of) {
    return of == 0 ? 0 : 100.0 * part / of;
}

void print(const char* name, const Counts& counts, float threshold) {
    std::printf("%-10s  %12d  %12.1f %%  %14.1f %%  %12.2f %%  %14.2f %%  %18.3f\n", name,
                counts.inside, percent(counts.missed_fixed, counts.inside),
                percent(counts.missed_adaptive, counts.inside),
                percent(counts.false_fixed, counts.outside),
                percent(counts.false_adaptive, counts.outside), static_cast<double>(threshold));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2 || !std::filesystem::is_directory(argv[1])) {
        std::fprintf(stderr, "usage: drift FOLDER\n");
        return 2;
    }
    std::vector<std::filesystem::path> drives;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
        drives.push_back(entry.path());
    std::sort(drives.begin(), drives.end());

    std::printf("%-10s  %12s  %14s  %16s  %14s  %16s  %18s\n", "drives", "frames in A",
                "missed, fixed", "missed, adaptive", "false, fixed", "false, adaptive",
                "adaptive threshold");
    Watch watch;
    std::printf("%-10s  %12s  %14s  %16s  %14s  %16s  %18.3f\n", "before", "", "", "", "", "",
                static_cast<double>(watch.threshold()));
    for (std::size_t part = 0; part < kParts; ++part) {
        const std::size_t begin = drives.size() * part / kParts;
        const std::size_t end = drives.size() * (part + 1) / kParts;
        Counts counts;
        for (std::size_t n = begin; n < end; ++n) {
            if (watch.drive(drives[n], counts)) continue;
            std::fprintf(stderr, "drift: %s cannot be read\n", drives[n].c_str());
            return 1;
        }
        print((std::to_string(begin + 1) + " to " + std::to_string(end)).c_str(), counts,
              watch.threshold());
    }
    std::printf(
        "\n%d frames inside A were labelled; the adaptive threshold missed %d of them when the "
        "label came (%.1f %%)\n",
        watch.labelled(), watch.missed(), percent(watch.missed(), watch.labelled()));
}
