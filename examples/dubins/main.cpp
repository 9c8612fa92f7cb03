// dubins [OUTPUT_FOLDER [DRIVE]]: a hundred drives past the generated monitor of dubins.etl.
// Gives: on standard output a line per drive, then how often verdicts and truth agree; in
// OUTPUT_FOLDER (default: the current one) dubins.svg, a picture of one drive, and dubins.csv, the
// same drive as a trace for `etlc run`.
#include <fmt/core.h>

#include <charconv>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "monitoring.hpp"
#include "picture.hpp"
#include "recording_csv.hpp"
#include "report.hpp"

namespace demo {
namespace {

constexpr std::uint64_t kSeed = 2025;  // another than those in prepare.cpp
constexpr int kDrives = 100;
constexpr int kSteps = 240;  // 12 s

void write_picture(const std::string& path, const Recording& recording, int number) {
    std::ofstream file(path);
    file << picture(recording, number);
    file.close();
    if (!file) throw std::runtime_error(path + ": cannot be written");
}

void show(const std::string& folder, int pictured) {
    std::filesystem::create_directories(folder);
    const Encoder encoder = Encoder::load(DUBINS_FOLDER "/encoder");
    Report report;
    report.header();
    int number = 0;
    for (Episode& episode : drive_tours(kSeed, kDrives, kSteps)) {
        const Recording recording = monitor_drive(std::move(episode), encoder);
        report.add(recording);
        if (++number != pictured) continue;
        write_picture(folder + "/dubins.svg", recording, number);
        std::vector<Embedding> embeddings;
        for (const Step& step : recording.steps) embeddings.push_back(step.embedding);
        write_csv(folder + "/dubins.csv", recording.episode.states, embeddings);
    }
    report.summary();
    fmt::print("\ndrive {} is drawn in {}/dubins.svg and recorded in {}/dubins.csv\n", pictured,
               folder, folder);
}

int drive_number(std::string_view text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number < 1 ||
        number > kDrives) {
        throw std::invalid_argument(
            fmt::format("the drive is a number from 1 to {}, not {}", kDrives, text));
    }
    return number;
}

}  // namespace
}  // namespace demo

int main(int argc, char** argv) {
    if (argc > 3) {
        fmt::print(stderr, "usage: dubins [OUTPUT_FOLDER [DRIVE]]\n");
        return 2;
    }
    try {
        demo::show(argc > 1 ? argv[1] : ".", argc > 2 ? demo::drive_number(argv[2]) : 9);
    } catch (const std::invalid_argument& error) {
        fmt::print(stderr, "dubins: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "dubins: {}\n", error.what());
        return 1;
    }
}
