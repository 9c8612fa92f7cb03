// dubins_prepare [FOLDER]: makes the committed files of the example from seeds.
// Gives: FOLDER/encoder/{mean,components}.npy, FOLDER/targets/*.npy, and on standard output the
// thresholds for dubins.etl. Keeps true: the encoder is fitted on cars that wander at random, the
// thresholds on tours that `dubins` does not show.
#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>

#include "episode.hpp"
#include "npy.hpp"
#include "score.hpp"
#include "targets.hpp"

namespace demo {
namespace {

constexpr std::uint64_t kWanderSeed = 7;
constexpr std::uint64_t kTuningSeed = 11;  // differs from that of the tours in main.cpp
constexpr int kImages = 3000;
constexpr int kTours = 100;
constexpr int kSteps = 240;

double cosine_distance(const Embedding& a, const Embedding& b) {
    const Eigen::Map<const Eigen::Matrix<float, kDimension, 1>> u(a.data());
    const Eigen::Map<const Eigen::Matrix<float, kDimension, 1>> v(b.data());
    const Eigen::VectorXd p = u.cast<double>().normalized();
    const Eigen::VectorXd q = v.cast<double>().normalized();
    return 1 - p.dot(q);
}

struct Frame {
    double distance;
    bool inside;
};

/// Returns the threshold with the best F1 among all thresholds between neighbouring observed
/// distances ("F1-Optimal Threshold").
std::pair<double, Score> best_threshold(std::vector<Frame> frames) {
    std::sort(frames.begin(), frames.end(),
              [](const Frame& a, const Frame& b) { return a.distance < b.distance; });
    Score score;
    for (const Frame& frame : frames) score.count(false, frame.inside);
    std::pair<double, Score> best{0, score};
    for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
        ++(frames[i].inside ? score.true_positives : score.false_positives);
        --(frames[i].inside ? score.false_negatives : score.true_negatives);
        const double between = (frames[i].distance + frames[i + 1].distance) / 2;
        if (score.f1() > best.second.f1()) best = {between, score};
    }
    return best;
}

std::vector<Frame> measure(const Encoder& encoder, const std::vector<Embedding>& targets,
                           const Disc& disc, const std::vector<Episode>& tours) {
    std::vector<Frame> frames;
    for (const Episode& tour : tours) {
        for (const Car& car : tour.states) {
            const Embedding seen = encoder.encode(photograph(car));
            double nearest = 2;
            for (const Embedding& target : targets)
                nearest = std::min(nearest, cosine_distance(seen, target));
            frames.push_back({nearest, disc.contains(car.position)});
        }
    }
    return frames;
}

void prepare(const std::string& folder) {
    std::filesystem::create_directories(folder + "/encoder");
    std::filesystem::create_directories(folder + "/targets");
    std::vector<Image> images;
    for (const Car& car : wander(kWanderSeed, kImages)) images.push_back(photograph(car));
    const Encoder encoder = Encoder::fit(images);
    encoder.save(folder + "/encoder");
    fmt::print("encoder: {} components keep {:.1f} % of the variance of {} images\n\n", kDimension,
               100 * encoder.kept_variance(), images.size());

    const std::vector<Episode> tours = drive_tours(kTuningSeed, kTours, kSteps);
    fmt::print("predicate  threshold     F1  precision  recall  frames inside (of {}, {} tours)\n",
               tours.size() * kSteps, tours.size());
    for (const Region& region : kRegions) {
        const std::vector<Embedding> rows = target_set(encoder, region.disc.centre);
        Eigen::MatrixXf matrix(static_cast<Eigen::Index>(rows.size()), kDimension);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            matrix.row(static_cast<Eigen::Index>(i)) =
                Eigen::Map<const Eigen::RowVectorXf>(rows[i].data(), kDimension);
        }
        write_matrix(fmt::format("{}/targets/{}.npy", folder, region.name), matrix);
        const auto [threshold, score] = best_threshold(measure(encoder, rows, region.disc, tours));
        fmt::print("{:<9}  {:9.3f}  {:5.3f}  {:9.3f}  {:6.3f}  {}\n", region.predicate, threshold,
                   score.f1(), score.precision(), score.recall(), score.positives());
    }
}

}  // namespace
}  // namespace demo

int main(int argc, char** argv) {
    if (argc > 2) {
        fmt::print(stderr, "usage: dubins_prepare [FOLDER]\n");
        return 2;
    }
    try {
        demo::prepare(argc > 1 ? argv[1] : DUBINS_FOLDER);
    } catch (const std::exception& error) {
        fmt::print(stderr, "dubins_prepare: {}\n", error.what());
        return 1;
    }
}
