#include "process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>

namespace etlc::faults {

namespace {

void connect(int standard, Stream stream, int open) {
    if (stream == Stream::open) ::dup2(open, standard);
    if (stream == Stream::full) ::dup2(::open("/dev/full", O_RDWR), standard);
    if (stream == Stream::closed) ::close(standard);
}

void limit(int what, rlim_t most) {
    const rlimit both{most, most};
    if (most != RLIM_INFINITY) ::setrlimit(static_cast<__rlimit_resource>(what), &both);
}

std::string content(int file) {
    std::string all;
    std::array<char, 1U << 16U> buffer;
    while (true) {
        const ssize_t n = ::read(file, buffer.data(), buffer.size());
        if (n <= 0) return all;
        all.append(buffer.data(), static_cast<std::size_t>(n));
    }
}

}  // namespace

Process::Process(const std::vector<std::string>& words, const std::string& folder,
                 const Surroundings& around)
    : killed_after_(around.killed_after) {
    // The output of a process fits into a pipe; it has limits like a file.
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) std::abort();
    ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
    error_ = ends[0];
    output_ = ::memfd_create("output", MFD_CLOEXEC);
    std::vector<char*> pointers;
    for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
    pointers.push_back(nullptr);
    id_ = ::fork();
    if (id_ == 0) {
        if (::chdir(folder.c_str()) != 0) ::_exit(126);
        if (!around.injection.empty() || !around.counts.empty()) {
            ::setenv("LD_PRELOAD", kInjectionLibrary, 1);
            ::setenv("ETLC_INJECT", around.injection.c_str(), 1);
            if (!around.counts.empty()) ::setenv("ETLC_INJECT_COUNTS", around.counts.c_str(), 1);
        }
        connect(STDIN_FILENO, around.input, ::open("/dev/null", O_RDONLY | O_CLOEXEC));
        connect(STDOUT_FILENO, around.output, output_);
        connect(STDERR_FILENO, around.error, ends[1]);
        limit(RLIMIT_CORE, 0);
        limit(RLIMIT_FSIZE, around.file_bytes);
        limit(RLIMIT_AS, around.address_space);
        ::execv(pointers[0], pointers.data());
        ::_exit(126);
    }
    ::close(ends[1]);
}

Outcome Process::outcome() {
    if (killed_after_) {
        ::usleep(static_cast<useconds_t>(1e6 * *killed_after_));
        ::kill(id_, SIGKILL);
    }
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    Outcome result;
    if (WIFEXITED(status)) result.status = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
    ::lseek(output_, 0, SEEK_SET);
    result.output = content(output_);
    result.error = content(error_);
    ::close(output_);
    ::close(error_);
    return result;
}

}  // namespace etlc::faults
