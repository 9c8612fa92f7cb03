// Tests every way to a guarantee, and what voids it: targets that are frames, repeated episodes,
// and episodes used for thresholds. In each case the same world without these faults is accepted.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "driver/commands/commands.hpp"
#include "random.hpp"
#include "roads.hpp"

namespace etlc::tests {
namespace {

using Codes = std::vector<std::string>;

constexpr int kEpisodes = 12;
constexpr int kRoadSteps = 5;
constexpr int kElements = 3;

/// A frame as recorded, before any input narrows it.
struct RoadFrame {
    std::vector<double> z;
    double px = 0, py = 0;
    bool label = false;
};
using Drive = std::vector<RoadFrame>;

Drive random_drive(Random& random) {
    Drive episode;
    for (int t = 0; t < kRoadSteps; ++t) {
        RoadFrame frame;
        frame.label = random.chance(0.5);
        const double centre = frame.label ? 0.2 : 1;
        for (int i = 0; i < kElements; ++i)
            frame.z.push_back(centre + 0.3 * (random.uniform() - 0.5));
        frame.px = centre + random.uniform();
        frame.py = random.uniform();
        episode.push_back(frame);
    }
    return episode;
}

std::vector<Drive> random_drives(Random& random) {
    std::vector<Drive> episodes;
    for (int i = 0; i < kEpisodes; ++i) episodes.push_back(random_drive(random));
    return episodes;
}

/// How frames are recorded, and the form of a row taken from one of them.
struct Form {
    std::string type;  ///< the declaration of z
    double grain = 0;  ///< int8: z is recorded as multiples of it
    std::vector<double> (*row)(const RoadFrame&, double grain);  ///< the declaration of the target
                                                                 ///< set
};

std::vector<double> as_it_is(const RoadFrame& frame, double) {
    return frame.z;
}
std::vector<double> of_twice_the_length(const RoadFrame& frame, double) {
    std::vector<double> row;
    for (const double x : frame.z) row.push_back(2 * static_cast<double>(static_cast<float>(x)));
    return row;
}
/// The embedding before it was recorded as integers.
std::vector<double> unrounded(const RoadFrame& frame, double grain) {
    std::vector<double> row;
    for (const double x : frame.z) row.push_back((std::round(x / grain) + 0.3) * grain);
    return row;
}
std::vector<double> position(const RoadFrame& frame, double) {
    return {frame.px, frame.py};
}

const Form kF32{"f32[3]", 0, as_it_is};
const Form kF32Held{"f32[3] hold 2", 0, as_it_is};
const Form kF16{"f16[3]", 0, as_it_is};
const Form kI8{"i8[3] scale 0.015625", 0.015625, unrounded};
const Form kDirection{"f32[3]", 0, of_twice_the_length};
const Form kPosition{"f32[3]", 0, position};

struct Road {
    std::string measure;    ///< the left side of predicate a
    std::string threshold;  ///< and its threshold
    std::string monitor;
    const Form* form = &kF32;

    bool of_predicates() const { return threshold.find("calibrated") != std::string::npos; }
    bool of_monitor() const { return monitor.find("calibrated") != std::string::npos; }
    std::string text() const {
        return measure + " " + threshold + "; " + monitor + " " + form->type;
    }
};

const std::string kConformal = "calibrated(conformal, alpha = 0.25)";
const std::string kAlarms = " calibrated(conformal, alpha = 0.25, against = missed_alarm)";
const std::string kSuccesses = " calibrated(conformal, alpha = 0.25, against = missed_success)";

std::vector<Road> roads() {
    std::vector<Road> all;
    for (const std::string measure : {"min l2(z, g)", "max l1(z, g)", "mean l2sq(z, g)",
                                      "kth(2) linf(z, g)", "min mahalanobis([1, 2, 3])(z, g)"})
        all.push_back({measure, "<= " + kConformal, "F a"});
    for (const Form* form : {&kF32Held, &kF16, &kI8})
        all.push_back({"min l2(z, g)", "< " + kConformal, "G !a", form});
    for (const std::string measure : {"min cosine(z, g)", "max angular(z, g)"})
        all.push_back({measure, "<= " + kConformal, "F a", &kDirection});
    for (const std::string threshold :
         {"<= calibrated(f1)", "<= calibrated(class_conditional, alpha = 0.25)",
          "<= calibrated(adaptive, alpha = 0.25, gamma = 0.01, lo = 0, hi = 5)"})
        all.push_back({"min l2(z, g)", threshold, "F a"});
    all.push_back({"min l2(z, far) - min l2(z, g)", ">= " + kConformal, "F a"});
    all.push_back({"min l2([px, py], g)", "<= " + kConformal, "F a", &kPosition});
    for (const std::string threshold :
         {"<= 0.4", "<= calibrated(conformal, alpha = 0.25)", "<= calibrated(f1)",
          "<= calibrated(class_conditional, alpha = 0.25)"})
        for (const std::string& monitor :
             {"F a" + kAlarms, "F a" + kSuccesses, "G (a -> px < 0.8)" + kAlarms})
            all.push_back({"min l2(z, g)", threshold, monitor});
    for (const Form* form : {&kF32Held, &kF16, &kI8})
        all.push_back({"min l2(z, g)", "<= 0.4", "F a" + kSuccesses, form});
    all.push_back({"min cosine(z, g)", "<= 0.01", "F a" + kSuccesses, &kDirection});
    all.push_back({"min l2([px, py], g)", "<= 1", "F a" + kSuccesses, &kPosition});
    all.push_back({"min l2(z, far) - min l2(z, g)", ">= 0.5", "F[0, 2] a" + kAlarms});
    return all;
}

std::string csv(const Drive& episode, const Road& road) {
    std::string text = "z[0],z[1],z[2],px,py,truth.a\n";
    const double grain = road.form->grain;
    for (const RoadFrame& frame : episode) {
        for (const double x : frame.z)
            text += fmt::format("{},", grain > 0 ? std::round(x / grain) : x);
        text += fmt::format("{},{},{}\n", frame.px, frame.py, frame.label ? 1 : 0);
    }
    return text;
}

/// One world. Thresholds of predicates are calibrated on `first` if the monitor is calibrated after
/// them.
class World {
public:
    World(const Road& road, std::uint64_t seed) : road_(road) {
        Random random(seed);
        first_ = random_drives(random);
        second_ = random_drives(random);
        for (int i = 0; i < 3; ++i)
            rows_.push_back(road.form->row(random_drive(random)[0], road.form->grain));
    }

    void leak_first() { rows_[1] = road_.form->row(first_[2][3], road_.form->grain); }
    void leak_second() { rows_[1] = road_.form->row(second_[2][3], road_.form->grain); }
    void repeat() { second_.push_back(second_[2]); }
    void see() { second_.push_back(first_[1]); }

    /// Returns the codes of the first call that refuses; the thresholds file of the last.
    Codes take() {
        std::string before;
        if (road_.of_predicates() && road_.of_monitor()) {
            const Calibrated predicates = calibrate(first_, "");
            if (!predicates.codes.empty()) return predicates.codes;
            before = predicates.thresholds;
        }
        const Calibrated last = calibrate(second_, before);
        thresholds = last.thresholds;
        return last.codes;
    }

    /// Returns the messages of compiling with this thresholds file.
    Codes compile() const {
        const TemporaryPath targets("g.npy", npy_rows());
        const TemporaryPath file("thresholds.json", thresholds);
        driver::Request request;
        request.check.thresholds_path = file.path();
        diag::Sink sink;
        etlc::compile(source::File("t.etl", spec(targets.path())), request.check, request, sink);
        return error_codes(sink);
    }

    std::string thresholds;

private:
    Calibrated calibrate(const std::vector<Drive>& episodes, const std::string& before) const {
        const TemporaryPath targets("g.npy", npy_rows());
        Files files;
        for (const Drive& episode : episodes) files.add(csv(episode, road_));
        return calibrated(spec(targets.path()), files.paths(), before);
    }

    std::string npy_rows() const {
        std::vector<float> values;
        for (const auto& row : rows_)
            for (const double x : row) values.push_back(static_cast<float>(x));
        return npy("<f4", fmt::format("({}, {})", rows_.size(), rows_[0].size()), floats(values));
    }

    std::string spec(const std::string& targets) const {
        return fmt::format(
            "spec t; input z : {}; input px, py : f32; target g = load(\"{}\"); target far = [[1, "
            "1, 1]];\n"
            "predicate a = {} {}; monitor m = {};",
            road_.form->type, targets, road_.measure, road_.threshold, road_.monitor);
    }

    const Road& road_;
    std::vector<Drive> first_;
    std::vector<Drive> second_;
    std::vector<std::vector<double>> rows_;
};

TEST(Roads, RefuseWhatVoidsTheGuarantee) {
    std::uint64_t seed = 300;
    for (const Road& road : roads()) {
        SCOPED_TRACE(road.text());
        ++seed;
        const auto taken = [&](void (World::*fault)()) {
            World world(road, seed);
            if (fault != nullptr) (world.*fault)();
            return world.take();
        };
        World clean(road, seed);
        ASSERT_EQ(clean.take(), Codes{});
        EXPECT_EQ(clean.compile(), Codes{});
        EXPECT_EQ(taken(&World::leak_second), Codes{"E0665"});
        EXPECT_EQ(taken(&World::repeat), Codes{"E0664"});
        if (!road.of_predicates() || !road.of_monitor()) continue;
        EXPECT_EQ(taken(&World::leak_first), Codes{"E0665"});
        EXPECT_EQ(taken(&World::see), Codes{"E0666"});
    }
}

/// A position may well equal a target that is written down.
TEST(Roads, AWrittenTargetOfScalarsIsNoLeak) {
    const Files files({"px,py,truth.a\n0,0,1\n3,4,0\n", "px,py,truth.a\n0,0.5,1\n3,4.5,0\n"});
    const std::string spec =
        "spec t; input px, py : f32; target g = [[0, 0]]; predicate a = l2([px, py], g) <= "
        "calibrated(conformal, alpha = 0.5); monitor m = F a;";
    EXPECT_EQ(calibrated(spec, files.paths()).codes, Codes{});
}

/// A comparison that is its own truth cannot be wrong.
TEST(Roads, AComparisonWithoutATruthGuaranteesNothing) {
    const Files files({"z[0]\n0\n1\n", "z[0]\n0.5\n2\n"});
    const std::string spec =
        "spec t; input z : f32[1]; target g = [[0.25]]; monitor m = F (l2(z, g) <= 0.5)" + kAlarms;
    EXPECT_EQ(calibrated(spec + ";", files.paths()).codes, Codes{"E0655"});
}

}  // namespace
}  // namespace etlc::tests
