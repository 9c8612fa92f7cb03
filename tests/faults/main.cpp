// faults ETLC DATA [--long]: runs etlc under faults of the system. DATA is tests/unit/data. Every
// command runs while system calls fail, threads cannot be created, memory, files and streams are
// limited, and while it is killed; two commands run at the same time. The exit status is 1 if a run
// violates a rule of Judge.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>

#include "judge.hpp"
#include "scene.hpp"

namespace {

using namespace etlc::faults;

constexpr long kEvery = 1'000'000;  ///< calls: all from one on

/// The number of faults of each kind.
struct Extent {
    long places;  ///< disturbed calls, of each kind and command
    long allocations;
    int memories;  ///< limits of the address space
    int kills;     ///< kills at random moments
    int pairs;     ///< simultaneous calls
};
constexpr Extent kShort{5, 24, 6, 10, 20};
constexpr Extent kLong{20, 150, 20, 100, 150};

struct Disturbance {
    const char* call;
    std::vector<std::string> actions;  ///< errors by number
    long count;                        ///< numbers of calls in a row
};

/// Faults of each kind of call. Errors are those of Linux.
const std::vector<Disturbance>& disturbances() {
    const auto error = [](int number) { return std::to_string(number); };
    static const std::vector<Disturbance> all = {
        {"write", {error(ENOSPC), error(EINTR), "short"}, 1},
        {"write", {error(EIO), "short"}, kEvery},
        {"open", {error(EMFILE)}, 1},
        {"open", {error(ENFILE)}, kEvery},
        {"close", {error(EIO), error(EINTR)}, 1},
        {"link", {error(EPERM), error(ENOSPC)}, 1},
        {"rename", {error(EBUSY)}, 1},
        {"dup", {error(EMFILE)}, 1},
        {"lock", {error(ENOLCK), error(EINTR)}, 1},
        {"change", {error(EPERM)}, kEvery},
        {"thread", {error(EAGAIN)}, 1},
        {"thread", {error(EAGAIN)}, kEvery},
        {"spawn", {error(EAGAIN)}, 1},
        {"pipe", {error(EMFILE)}, 1},
        {"malloc", {error(ENOMEM)}, 1},
        {"malloc", {error(ENOMEM)}, kEvery},
    };
    return all;
}

/// Returns numbers from 1 to `last`, at most `most` of them, both ends included.
std::vector<long> spread(long last, long most) {
    std::vector<long> places;
    const long n = std::min(last, most);
    for (long i = 0; i < n; ++i) places.push_back(n == 1 ? 1 : 1 + i * (last - 1) / (n - 1));
    return places;
}

class Campaign {
public:
    Campaign(Scene& scene, const Extent& extent) : scene_(scene), extent_(extent) {}

    void run() {
        for (const Command& command : scene_.commands()) {
            fail_calls(command);
            break_streams(command);
            limit_files(command);
            limit_memory(command);
            kill_at_random(command);
            fmt::print("{}: {} runs so far, {} findings\n", command.name, judge_.runs(),
                       judge_.findings().size());
            std::fflush(stdout);
        }
        run_at_the_same_time();
    }

    int report() const {
        for (const std::string& finding : judge_.findings()) fmt::print("{}\n", finding);
        fmt::print("{} commands, {} runs among faults, {} of them killed: {} findings\n",
                   scene_.commands().size(), judge_.runs(), judge_.killed(),
                   judge_.findings().size());
        return judge_.findings().empty() ? 0 : 1;
    }

private:
    void fail_calls(const Command& command) {
        for (const Disturbance& disturbance : disturbances()) {
            const std::string call = disturbance.call;
            // CLI11 writes its help through streams, which ignore a single failed allocation.
            if (call == "malloc" && disturbance.count == 1 && command.words.back() == "--help")
                continue;
            const long most = call == "malloc" ? extent_.allocations : extent_.places;
            for (const long first : spread(command.calls.at(call), most))
                for (const std::string& action : disturbance.actions) {
                    Surroundings around;
                    around.injection =
                        fmt::format("{}:{}:{}:{}", call, first, disturbance.count, action);
                    disturb(command, around, around.injection);
                }
        }
    }

    void break_streams(const Command& command) {
        for (const Stream input : {Stream::open, Stream::closed})
            for (const Stream output : {Stream::open, Stream::full, Stream::closed})
                for (const Stream error : {Stream::open, Stream::full, Stream::closed}) {
                    Surroundings around;
                    around.input = input;
                    around.output = output;
                    around.error = error;
                    const auto words = [](Stream stream) {
                        return stream == Stream::open   ? "open"
                               : stream == Stream::full ? "full"
                                                        : "closed";
                    };
                    disturb(command, around,
                            fmt::format("input {}, output {}, error {}", words(input),
                                        words(output), words(error)));
                }
    }

    void limit_files(const Command& command) {
        for (const rlim_t bytes : {0, 1, 100, 1000, 4096}) {
            Surroundings around;
            around.file_bytes = bytes;
            disturb(command, around, fmt::format("files of at most {} bytes", bytes));
        }
    }

    /// From the least that starts to the least that finishes.
    void limit_memory(const Command& command) {
        const Command& version = scene_.commands().back();
        const rlim_t least = least_memory(version);
        const rlim_t enough = least_memory(command);
        for (int i = 0; i < extent_.memories; ++i) {
            Surroundings around;
            around.address_space = least + (enough - least) * static_cast<rlim_t>(i) /
                                               static_cast<rlim_t>(extent_.memories);
            disturb(command, around,
                    fmt::format("at most {} KiB of memory", around.address_space >> 10U));
        }
    }

    rlim_t least_memory(const Command& command) {
        rlim_t fails = 1U << 20U;
        rlim_t works = rlim_t{1} << 31U;
        while (works - fails > (64U << 10U)) {
            Surroundings around;
            around.address_space = fails + (works - fails) / 2;
            scene_.restore(command);
            (scene_.run(command, around).status == command.undisturbed.status ? works : fails) =
                around.address_space;
        }
        return works;
    }

    void kill_at_random(const Command& command) {
        const auto begin = std::chrono::steady_clock::now();
        scene_.run(command, {});
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
        for (int i = 0; i < extent_.kills; ++i) {
            Surroundings around;
            around.killed_after = std::uniform_real_distribution<>(0, time.count())(random_);
            disturb(command, around, fmt::format("killed after {} s", *around.killed_after));
        }
    }

    void disturb(const Command& command, const Surroundings& around, const std::string& what) {
        scene_.restore(command);
        judge_.judge(scene_, command, around, what, scene_.run(command, around));
    }

    /// The specs differ, the output files are the same: in the end they belong to one call.
    void run_at_the_same_time() {
        const Command& command = scene_.commands().front();
        Command earlier = command;
        earlier.words[0] = scene_.write_earlier_spec();
        for (int i = 0; i < extent_.pairs; ++i) {
            scene_.restore(command);
            Process one = scene_.start(earlier, {});
            ::usleep(std::uniform_int_distribution<useconds_t>(0, 4000)(random_));
            Process other = scene_.start(command, {});
            const Outcome first = one.outcome();
            judge_.judge_pair(scene_, command, first, other.outcome());
        }
    }

    Scene& scene_;
    Extent extent_;
    Judge judge_;
    std::mt19937 random_{1};
};

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    Scene scene(argv[1], argv[2]);
    Campaign campaign(scene, argc > 3 && std::string(argv[3]) == "--long" ? kLong : kShort);
    campaign.run();
    return campaign.report();
}
