#include "recordings/records/protocol.hpp"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace etlc::recordings::records {
namespace {

void write_all(const char* bytes, std::size_t n) {
    while (n > 0) {
        const ssize_t written = ::write(STDOUT_FILENO, bytes, n);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) quit(1);
        bytes += written;
        n -= static_cast<std::size_t>(written);
    }
}

void allow_time() {
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    const auto seconds = static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec);
    const rlimit limit{seconds + kMaxBlockSeconds, RLIM_INFINITY};
    ::setrlimit(RLIMIT_CPU, &limit);
}

}  // namespace

void limit_resources(std::uint64_t mapped) {
    const rlimit memory{kMaxMemoryBytes + mapped, kMaxMemoryBytes + mapped};
    const rlimit nothing{0, 0};
    const rlimit files{64, 64};
    ::setrlimit(RLIMIT_AS, &memory);
    ::setrlimit(RLIMIT_CORE, &nothing);
    ::setrlimit(RLIMIT_FSIZE, &nothing);
    ::setrlimit(RLIMIT_NOFILE, &files);
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    allow_time();
}

void send(Tag tag, const char* bytes, std::size_t n) {
    char head[5] = {static_cast<char>(tag)};
    const auto length = static_cast<std::uint32_t>(n);
    std::memcpy(head + 1, &length, sizeof length);
    write_all(head, sizeof head);
    write_all(bytes, n);
    allow_time();
}

void send(Tag tag, const std::string& text) {
    send(tag, text.data(), text.size());
}

void quit(int status) {
    ::_exit(status);
}

void fail(Cause cause, const std::string& text) {
    send(Tag::failure, static_cast<char>(cause) + text);
    quit(0);
}

void done() {
    send(Tag::end, "", 0);
    quit(0);
}

}  // namespace etlc::recordings::records
