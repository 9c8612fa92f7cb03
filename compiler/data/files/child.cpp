#include "data/files/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace etlc::data {
namespace {

/// Only what finds the libraries: nothing in the environment shall change what the program does.
std::vector<std::string> environment() {
    const char* const libraries = std::getenv("LD_LIBRARY_PATH");
    if (libraries == nullptr) return {};
    return {std::string("LD_LIBRARY_PATH=") + libraries};
}

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> result;
    for (std::string& word : words) result.push_back(word.data());
    result.push_back(nullptr);
    return result;
}

}  // namespace

std::unique_ptr<Child> Child::start(const std::string& program,
                                    const std::vector<std::string>& arguments,
                                    int max_silence_seconds) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return nullptr;
    posix_spawn_file_actions_t actions{};
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::vector<std::string> words = {program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<std::string> settings = environment();
    pid_t process = 0;
    const int status = ::posix_spawn(&process, program.c_str(), &actions, nullptr,
                                     pointers(words).data(), pointers(settings).data());
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (status == 0)
        return std::unique_ptr<Child>(new Child(process, ends[0], max_silence_seconds));
    ::close(ends[0]);
    return nullptr;
}

Child::~Child() {
    stop();
    ::close(output_);
}

void Child::stop() {
    if (process_ == 0) return;
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
}

bool Child::read(char* to, std::size_t n) {
    while (n > 0) {
        pollfd waiting{output_, POLLIN, 0};
        const int ready = ::poll(&waiting, 1, 1000 * max_silence_seconds_);
        if (ready < 0 && errno == EINTR) continue;
        silent_ = ready == 0;
        if (ready <= 0) return false;
        const ssize_t got = ::read(output_, to, n);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        to += got;
        n -= static_cast<std::size_t>(got);
    }
    return true;
}

std::string Child::ending() {
    if (silent_) {
        stop();
        return fmt::format("said nothing for {} seconds and was stopped", max_silence_seconds_);
    }
    int status = 0;
    pid_t ended = 0;
    while ((ended = ::waitpid(process_, &status, 0)) < 0 && errno == EINTR) {
    }
    process_ = 0;
    if (ended > 0 && WIFSIGNALED(status))
        return fmt::format("was stopped by signal {} ({})", WTERMSIG(status),
                           ::strsignal(WTERMSIG(status)));
    return fmt::format("ended too soon, with exit status {}",
                       WIFEXITED(status) ? WEXITSTATUS(status) : -1);
}

}  // namespace etlc::data
