// dubins_record FOLDER SEED...: records drives as episodes for `etlc calibrate` and `etlc
// evaluate`.
// Gives: for each seed 300 drives, 120 in FOLDER/SEED/calibration, 180 in FOLDER/SEED/test, one
// .csv each. Keeps true: the seed assigns drives to the two sides at random, whatever their plan,
// so the two sides are exchangeable.
//
// dubins_record --sagging FOLDER SEED...: for each seed 300 drives in FOLDER/SEED/sagging, in the
// order of their names, from a camera whose picture moves: not over the first 100, increasingly
// over the next 100, and fully over the last.
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <filesystem>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "encoder.hpp"
#include "episode.hpp"
#include "random.hpp"
#include "record_files.hpp"

namespace demo {
namespace {

constexpr int kDrives = 300;
constexpr int kForCalibration = 120;  // 40 %
constexpr int kSteps = 240;           // 12 s
constexpr double kMostRows = 3;       // of the picture, 14 cm

/// Returns 0 to n - 1 in a random order (Fisher and Yates).
std::vector<int> shuffled(int n, std::uint64_t seed) {
    Random random(seed);
    std::vector<int> order(static_cast<std::size_t>(n));
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = order.size(); i > 1; --i)
        std::swap(order[i - 1], order[random.bits() % i]);
    return order;
}

void record(const std::string& folder, std::uint64_t seed, const Encoder& encoder) {
    for (const char* side : {"calibration", "test"})
        std::filesystem::create_directories(folder + "/" + side);
    const std::vector<Episode> drives = drive_tours(seed, kDrives, kSteps);
    const std::vector<int> order = shuffled(kDrives, ~seed);
    for (int place = 0; place < kDrives; ++place) {
        const Episode& drive =
            drives[static_cast<std::size_t>(order[static_cast<std::size_t>(place)])];
        std::vector<Embedding> embeddings;
        for (const Car& car : drive.states) embeddings.push_back(encoder.encode(photograph(car)));
        const char* side = place < kForCalibration ? "calibration" : "test";
        write_csv(fmt::format("{}/{}/{:03}.csv", folder, side, place), drive.states, embeddings);
    }
}

/// Returns the image of a camera whose mount gave way: moved up, by fractions of a row too, with
/// ground below it.
Image moved_up(const Image& image, double rows) {
    Image result;
    result.fill(255);
    const int whole = static_cast<int>(rows);
    const double share = rows - whole;
    const auto at = [&](int row, int column) {
        return row < kImageSide ? image[static_cast<std::size_t>(row * kImageSide + column)]
                                : 255.0;
    };
    for (int row = 0; row < kImageSide; ++row)
        for (int column = 0; column < kImageSide; ++column)
            result[static_cast<std::size_t>(row * kImageSide + column)] =
                static_cast<std::uint8_t>(std::lround((1 - share) * at(row + whole, column) +
                                                      share * at(row + whole + 1, column)));
    return result;
}

void record_sagging(const std::string& folder, std::uint64_t seed, const Encoder& encoder) {
    std::filesystem::create_directories(folder);
    const std::vector<Episode> drives = drive_tours(seed, kDrives, kSteps);
    const std::vector<int> order = shuffled(kDrives, ~seed);
    for (int place = 0; place < kDrives; ++place) {
        const Episode& drive =
            drives[static_cast<std::size_t>(order[static_cast<std::size_t>(place)])];
        std::vector<Embedding> embeddings;
        for (std::size_t step = 0; step < drive.states.size(); ++step) {
            const double done = (place + static_cast<double>(step) / kSteps) / kDrives;
            const double rows = kMostRows * std::clamp(3 * done - 1, 0.0, 1.0);
            embeddings.push_back(encoder.encode(moved_up(photograph(drive.states[step]), rows)));
        }
        write_csv(fmt::format("{}/{:03}.csv", folder, place), drive.states, embeddings);
    }
}

std::uint64_t seed_of(std::string_view text) {
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error != std::errc() || end != text.data() + text.size())
        throw std::invalid_argument(fmt::format("a seed is a whole number, not {}", text));
    return seed;
}

}  // namespace
}  // namespace demo

int main(int argc, char** argv) {
    const bool sagging = argc > 1 && std::string_view(argv[1]) == "--sagging";
    const int first = sagging ? 2 : 1;
    if (argc < first + 2) {
        fmt::print(stderr, "usage: dubins_record [--sagging] FOLDER SEED...\n");
        return 2;
    }
    try {
        const demo::Encoder encoder = demo::Encoder::load(DUBINS_FOLDER "/encoder");
        for (int i = first + 1; i < argc; ++i) {
            const std::uint64_t seed = demo::seed_of(argv[i]);
            const std::string folder = fmt::format("{}/{}", argv[first], argv[i]);
            if (sagging)
                demo::record_sagging(folder + "/sagging", seed, encoder);
            else
                demo::record(folder, seed, encoder);
        }
    } catch (const std::invalid_argument& error) {
        fmt::print(stderr, "dubins_record: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "dubins_record: {}\n", error.what());
        return 1;
    }
}
