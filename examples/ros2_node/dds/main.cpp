// patrol_dds FOLDER: runs the node over DDS, in the domain of ROS_DOMAIN_ID, until SIGINT or
// SIGTERM. Incidents go to FOLDER.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>

#include "ros_topics.hpp"

namespace {

using namespace patrol_node;

volatile std::sig_atomic_t stops = 0;

std::uint32_t domain() {
    const char* const text = std::getenv("ROS_DOMAIN_ID");
    return text == nullptr ? 0 : static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
}

void run(const char* incident_folder) {
    constexpr int kTicksPerDiagnostics = 10;  // once a second, and when a verdict changes
    RosTopics topics(domain());
    MonitorNode node(incident_folder);
    auto next = std::chrono::steady_clock::now();
    for (int ticks = 0; stops == 0; ++ticks) {
        next += kTick;
        std::this_thread::sleep_until(next);
        topics.take_references([&](const float* elements, std::size_t count) {
            node.take_references(elements, count);
        });
        topics.take([&](const float* elements, std::size_t count) { node.take(elements, count); });
        const Report report = node.tick();
        if (report.verdicts_changed) topics.publish_verdicts(report.verdicts);
        if (report.verdicts_changed || ticks % kTicksPerDiagnostics == 0)
            topics.publish_diagnostics(report.diagnostics);
    }
    node.reset();  // completes pending incidents
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: patrol_dds FOLDER\n", stderr);
        return 2;
    }
    std::signal(SIGINT, [](int) { stops = 1; });
    std::signal(SIGTERM, [](int) { stops = 1; });
    try {
        run(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "patrol_dds: %s\n", error.what());
        return 1;
    }
    return 0;
}
