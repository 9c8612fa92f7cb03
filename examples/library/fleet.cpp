// Steps one spec for several robots, each in its own thread, in C++.
//
// fleet SPEC.etl: prints, for each robot, the step at which `returns` raised its alarm.
#include <etlc.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace {

void check(etlc_status status) {
    if (status != ETLC_OK) throw std::runtime_error(etlc_message());
}

/// A session that is closed at the end of its scope. Only one thread may use it at a time.
class Monitor {
public:
    explicit Monitor(const std::string& path) {
        etlc_options options = ETLC_OPTIONS;
        options.path = path.c_str();
        check(etlc_open(&options, &session_));
        etlc_description spec{};
        spec.struct_size = sizeof spec;
        check(etlc_describe(session_, &spec));
        verdicts_.resize(spec.monitors);
    }
    ~Monitor() { etlc_close(session_); }
    Monitor(const Monitor&) = delete;
    Monitor& operator=(const Monitor&) = delete;

    std::uint32_t index_of(const char* monitor) const {
        std::uint32_t index = 0;
        check(etlc_find(session_, ETLC_MONITORS, monitor, &index));
        return index;
    }
    const std::vector<etlc_verdict>& step(const std::vector<etlc_sample>& samples) {
        check(etlc_step(session_, samples.data(), samples.size(), verdicts_.data(),
                        verdicts_.size()));
        return verdicts_;
    }

private:
    etlc_session session_ = 0;
    std::vector<etlc_verdict> verdicts_;
};

/// The robot reaches its dock at step `arrival`; its battery is low from step 5 on.
std::optional<int> first_alarm(const std::string& spec, int arrival) {
    constexpr std::array<float, 4> kShelf{0.1F, 0.9F, 0.3F, 0.0F};
    constexpr std::array<float, 4> kDock{0.9F, 0.1F, 0.0F, 0.2F};
    Monitor monitor(spec);
    const std::uint32_t returns = monitor.index_of("returns");
    for (int step = 0; step < 20; ++step) {
        const std::array<float, 4>& z = step < arrival ? kShelf : kDock;
        const float charge = step < 5 ? 0.8F : 0.2F;
        const auto& verdicts = monitor.step({{z.data(), 4, ETLC_F32}, {&charge, 1, ETLC_F32}});
        if (etlc_is_alarm(verdicts[returns]) != 0) return step;
    }
    return std::nullopt;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: fleet SPEC.etl\n");
        return 2;
    }
    const std::string spec = argv[1];
    const std::vector<int> arrivals{4, 9, 12, 30};
    std::vector<std::optional<int>> alarms(arrivals.size());
    std::vector<std::string> failures(arrivals.size());
    std::vector<std::thread> robots;
    for (std::size_t i = 0; i < arrivals.size(); ++i)
        robots.emplace_back([&, i] {
            try {
                alarms[i] = first_alarm(spec, arrivals[i]);
            } catch (const std::exception& error) {
                failures[i] = error.what();
            }
        });
    for (std::thread& robot : robots) robot.join();
    for (std::size_t i = 0; i < arrivals.size(); ++i) {
        if (!failures[i].empty()) {
            std::fprintf(stderr, "%s\n", failures[i].c_str());
            return 1;
        }
        std::printf(
            "robot %zu, at its dock at step %d: %s\n", i, arrivals[i],
            alarms[i] ? ("alarm at step " + std::to_string(*alarms[i])).c_str() : "no alarm");
    }
    return 0;
}
