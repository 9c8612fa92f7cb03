#include "watch/stop.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>

namespace etlc::watch {

namespace {

constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};

volatile sig_atomic_t is_asked_now = 0;
std::array<int, 2> ends = {-1, -1};
int nothing = -1;  ///< /dev/null, in place of standard input

void ask(int) {
    is_asked_now = 1;
    const char byte = 0;
    static_cast<void>(!::write(ends[1], &byte, 1));
    if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
}

}  // namespace

Stop::Stop(bool ends_input) {
    is_asked_now = 0;
    if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) ends = {-1, -1};
    if (ends_input) nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    struct sigaction action {};
    action.sa_handler = ask;
    action.sa_flags = SA_RESETHAND;
    for (const int signal : kSignals) ::sigaction(signal, &action, nullptr);
}

Stop::~Stop() {
    for (const int signal : kSignals) ::signal(signal, SIG_DFL);
    for (int* const descriptor : {&ends[0], &ends[1], &nothing}) {
        if (*descriptor >= 0) ::close(*descriptor);
        *descriptor = -1;
    }
}

bool Stop::is_asked() const {
    return is_asked_now != 0;
}

int Stop::descriptor() const {
    return ends[0];
}

}  // namespace etlc::watch
