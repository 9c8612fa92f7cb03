// dubins_record FOLDER SEED...: drives as episodes for `etlc calibrate` and `etlc evaluate`.
// Gives: for each seed 300 drives, 120 in FOLDER/SEED/calibration, 180 in FOLDER/SEED/test, one .csv each. Keeps true:
// which drive is on which side is drawn from the seed, whatever its plan, so the two sides are exchangeable.
#include <fmt/core.h>

#include <charconv>
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
#include "recording_csv.hpp"

namespace demo {
namespace {

constexpr int kDrives = 300;
constexpr int kForCalibration = 120;  // 40 %
constexpr int kSteps = 240;           // 12 s

/// 0 to n - 1 in a random order (Fisher and Yates).
std::vector<int> shuffled(int n, std::uint64_t seed) {
    Random random(seed);
    std::vector<int> order(static_cast<std::size_t>(n));
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.bits() % i]);
    return order;
}

void record(const std::string& folder, std::uint64_t seed, const Encoder& encoder) {
    for (const char* side : {"calibration", "test"}) std::filesystem::create_directories(folder + "/" + side);
    const std::vector<Episode> drives = drive_tours(seed, kDrives, kSteps);
    const std::vector<int> order = shuffled(kDrives, ~seed);
    for (int place = 0; place < kDrives; ++place) {
        const Episode& drive = drives[static_cast<std::size_t>(order[static_cast<std::size_t>(place)])];
        std::vector<Embedding> embeddings;
        for (const Car& car : drive.states) embeddings.push_back(encoder.encode(photograph(car)));
        const char* side = place < kForCalibration ? "calibration" : "test";
        write_csv(fmt::format("{}/{}/{:03}.csv", folder, side, place), drive.states, embeddings);
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
    if (argc < 3) {
        fmt::print(stderr, "usage: dubins_record FOLDER SEED...\n");
        return 2;
    }
    try {
        const demo::Encoder encoder = demo::Encoder::load(DUBINS_FOLDER "/encoder");
        for (int i = 2; i < argc; ++i)
            demo::record(fmt::format("{}/{}", argv[1], argv[i]), demo::seed_of(argv[i]), encoder);
    } catch (const std::invalid_argument& error) {
        fmt::print(stderr, "dubins_record: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "dubins_record: {}\n", error.what());
        return 1;
    }
}
