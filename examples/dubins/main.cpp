// dubins [OUTPUT_FOLDER]: runs a hundred drives through the generated monitor of dubins.etl.
// Gives: on standard output a line per drive, then how often verdicts and truth agree; in
// OUTPUT_FOLDER, if given, the drives as episodes for `etlc report`, 001.npz to 100.npz.
#include <fmt/core.h>

#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "monitoring.hpp"
#include "record_files.hpp"
#include "report.hpp"

namespace demo {
namespace {

constexpr std::uint64_t kSeed = 2025;  // differs from those in prepare.cpp
constexpr int kDrives = 100;
constexpr int kSteps = 240;  // 12 s

void write_drive(const std::string& path, const Recording& recording) {
    std::vector<Embedding> embeddings;
    for (const Step& step : recording.steps) embeddings.push_back(step.embedding);
    write_npz(path, recording.episode.states, embeddings);
}

/// `folder`: null if nothing is recorded.
void show(const char* folder) {
    if (folder != nullptr) std::filesystem::create_directories(folder);
    const Encoder encoder = Encoder::load(DUBINS_FOLDER "/encoder");
    Report report;
    report.header();
    int number = 0;
    for (Episode& episode : drive_tours(kSeed, kDrives, kSteps)) {
        const Recording recording = monitor_drive(std::move(episode), encoder);
        report.add(recording);
        ++number;
        if (folder != nullptr) write_drive(fmt::format("{}/{:03}.npz", folder, number), recording);
    }
    report.summary();
    if (folder != nullptr) fmt::print("\nthe drives are recorded in {}\n", folder);
}

}  // namespace
}  // namespace demo

int main(int argc, char** argv) {
    if (argc > 2) {
        fmt::print(stderr, "usage: dubins [OUTPUT_FOLDER]\n");
        return 2;
    }
    try {
        demo::show(argc > 1 ? argv[1] : nullptr);
    } catch (const std::exception& error) {
        fmt::print(stderr, "dubins: {}\n", error.what());
        return 1;
    }
}
