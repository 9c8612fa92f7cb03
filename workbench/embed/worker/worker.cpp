#include "embed/worker/worker.hpp"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

using namespace recordings::frames;

void refuse(int exit_status, const std::string& why) {
    std::fprintf(stderr, "%s\n", why.c_str());
    std::fflush(stderr);
    ::_exit(exit_status);
}

void write_out(const void* bytes, std::size_t size) {
    const auto* from = static_cast<const char*>(bytes);
    while (size > 0) {
        const ssize_t written = ::write(STDOUT_FILENO, from, size);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) ::_exit(EXIT_FAILURE);
        from += written;
        size -= static_cast<std::size_t>(written);
    }
}

void write_number(std::uint32_t number) {
    unsigned char bytes[4];
    for (unsigned i = 0; i < 4; ++i) bytes[i] = static_cast<unsigned char>(number >> (8 * i));
    write_out(bytes, sizeof bytes);
}

void write_frame(std::uint32_t height, std::uint32_t width, const std::uint8_t* rgb) {
    write_number(height);
    write_number(width);
    write_out(rgb, std::size_t{height} * width * 3);
}

bool read_in(void* to, std::size_t size) {
    auto* at = static_cast<char*>(to);
    std::size_t rest = size;
    while (rest > 0) {
        const ssize_t got = ::read(STDIN_FILENO, at, rest);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0 && rest < size) refuse(kWrongCall, "standard input ends in a frame");
        if (got <= 0) return false;
        at += got;
        rest -= static_cast<std::size_t>(got);
    }
    return true;
}

std::vector<double> Words::numbers(std::string_view name, std::vector<double> usual) const {
    for (std::size_t i = 0; i + 1 < words_.size(); i += 2) {
        if (words_[i] != name) continue;
        std::vector<double> result;
        const char* at = words_[i + 1].c_str();
        for (char* end = nullptr; *at != '\0'; at = *end == ',' ? end + 1 : end) {
            result.push_back(std::strtod(at, &end));
            if (end == at) refuse(kWrongCall, words_[i] + " takes numbers, not " + words_[i + 1]);
        }
        return result;
    }
    return usual;
}

std::string Words::text(std::string_view name, std::string usual) const {
    for (std::size_t i = 0; i + 1 < words_.size(); i += 2)
        if (words_[i] == name) return words_[i + 1];
    return usual;
}

void limit_resources(std::uint64_t memory) {
    const rlimit space{memory, memory};
    const rlimit nothing{0, 0};
    if (memory > 0) ::setrlimit(RLIMIT_AS, &space);
    ::setrlimit(RLIMIT_CORE, &nothing);
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
}

int guarded(int argc, char** argv, void (*run)(const std::vector<std::string>& words)) {
    try {
        run({argv + 1, argv + argc});
        std::fflush(nullptr);
        ::_exit(EXIT_SUCCESS);  // without waiting for threads of libraries
    } catch (const std::bad_alloc&) {
        refuse(kRefused, "takes more memory than reading it may");
    } catch (const std::exception& error) {
        refuse(kRefused, error.what());
    }
}

}  // namespace etlc::embed::worker
