// A library to preload that gives a program the clock of a test, so that no machine is too slow for
// it. ETLC_CLOCK names a file of 128 numbers: the time in nanoseconds, to which the test writes a
// later one when it likes, and the times that threads wait for, which the library writes. Only
// etlc-serve, which answers a browser, keeps the clock of the machine.
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/inotify.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

template <class Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// Returns whether this program has the clock of the machine.
bool is_left_alone() {
    static const bool is = std::strcmp(program_invocation_short_name, "etlc-serve") == 0;
    return is;
}

struct Shared {
    std::atomic<std::int64_t> now;
    std::array<std::atomic<std::int64_t>, 127> ends;  ///< 0: none
};

Shared& shared() {
    static Shared* const shared = [] {
        const char* const path = std::getenv("ETLC_CLOCK");
        const int file = path == nullptr ? -1 : ::open(path, O_RDWR | O_CLOEXEC);
        void* const memory =
            ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        if (memory == MAP_FAILED) std::abort();
        ::close(file);
        return static_cast<Shared*>(memory);
    }();
    return *shared;
}

std::int64_t nanoseconds(const timespec& time) {
    return time.tv_sec * kSecond + time.tv_nsec;
}

/// Can be read when the test has moved the clock.
class Moves {
public:
    Moves() : file_(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
        if (::inotify_add_watch(file_, std::getenv("ETLC_CLOCK"), IN_MODIFY) < 0) std::abort();
    }
    Moves(const Moves&) = delete;
    Moves& operator=(const Moves&) = delete;
    ~Moves() { ::close(file_); }

    pollfd awaited() const { return {file_, POLLIN, 0}; }
    void take() const {
        std::array<char, 4096> unused;
        while (::read(file_, unused.data(), unused.size()) > 0) {
        }
    }

private:
    int file_;
};

/// Shows the test until when a thread waits.
class Wait {
public:
    explicit Wait(std::int64_t end)
        : end_(std::find_if(shared().ends.begin(), shared().ends.end(), [&](auto& free) {
              std::int64_t none = 0;
              return free.compare_exchange_strong(none, end);
          })) {
        if (end_ == shared().ends.end()) std::abort();
    }
    Wait(const Wait&) = delete;
    Wait& operator=(const Wait&) = delete;
    ~Wait() { *end_ = 0; }

private:
    decltype(Shared::ends)::iterator end_;
};

int poll_until(pollfd* files, nfds_t count, std::int64_t end) {
    thread_local const Moves moves;
    const Wait wait(end);
    const auto poll = real<int(pollfd*, nfds_t, int)>("poll");
    std::vector<pollfd> all(files, files + count);
    all.push_back(moves.awaited());
    while (shared().now < end) {
        const int ready = poll(all.data(), all.size(), -1);
        if (ready < 0) return ready;
        moves.take();
        std::copy(all.begin(), all.end() - 1, files);
        if (const int others = ready - (all.back().revents != 0 ? 1 : 0); others > 0) return others;
    }
    return poll(files, count, 0);
}

/// Returns an environment of a program that etlc starts, which it makes itself, with this clock.
std::vector<char*> with_clock(char* const* environment) {
    static std::vector<std::string> own = {std::string("LD_PRELOAD=") + std::getenv("LD_PRELOAD"),
                                           std::string("ETLC_CLOCK=") + std::getenv("ETLC_CLOCK")};
    std::vector<char*> all = {own[0].data(), own[1].data()};
    while (*environment != nullptr) all.push_back(*environment++);
    all.push_back(nullptr);
    return all;
}

}  // namespace

// The exported functions have the names and types of the C library's functions.
extern "C" {

int clock_gettime(clockid_t clock, timespec* time) {
    if (clock != CLOCK_MONOTONIC || is_left_alone())
        return real<int(clockid_t, timespec*)>("clock_gettime")(clock, time);
    const std::int64_t now = shared().now;
    *time = {now / kSecond, now % kSecond};
    return 0;
}

int poll(pollfd* files, nfds_t count, int milliseconds) {
    if (milliseconds <= 0 || is_left_alone())
        return real<int(pollfd*, nfds_t, int)>("poll")(files, count, milliseconds);
    return poll_until(files, count, shared().now + std::int64_t{1'000'000} * milliseconds);
}

int nanosleep(const timespec* length, timespec* left) {
    if (is_left_alone()) return real<int(const timespec*, timespec*)>("nanosleep")(length, left);
    return poll_until(nullptr, 0, shared().now + nanoseconds(*length));
}

/// Returns the number of the error, as the C library's does.
int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* left) {
    const bool is_absolute = (flags & TIMER_ABSTIME) != 0;
    if (clock != CLOCK_MONOTONIC || is_left_alone())
        return real<int(clockid_t, int, const timespec*, timespec*)>("clock_nanosleep")(
            clock, flags, time, left);
    const std::int64_t end = nanoseconds(*time) + (is_absolute ? 0 : shared().now.load());
    return poll_until(nullptr, 0, end) < 0 ? errno : 0;
}

int posix_spawn(pid_t* process, const char* path, const posix_spawn_file_actions_t* actions,
                const posix_spawnattr_t* attributes, char* const* words, char* const* environment) {
    return real<decltype(posix_spawn)>("posix_spawn")(process, path, actions, attributes, words,
                                                      with_clock(environment).data());
}

int execve(const char* path, char* const* words, char* const* environment) {
    return real<decltype(execve)>("execve")(path, words, with_clock(environment).data());
}
}
