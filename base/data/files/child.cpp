#include "data/files/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

namespace etlc::data {
namespace {

/// Returns the environment of the child: all of it, or only what locates libraries, so that nothing
/// else changes what the program does.
std::vector<std::string> environment(const Child::Options& options) {
    std::vector<std::string> settings = options.variables;
    const char* const libraries = std::getenv("LD_LIBRARY_PATH");
    if (!options.whole_environment && libraries != nullptr)
        settings.push_back(std::string("LD_LIBRARY_PATH=") + libraries);
    for (char** own = environ; options.whole_environment && *own != nullptr; ++own)
        settings.emplace_back(*own);
    return settings;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> result;
    for (std::string& word : words) result.push_back(word.data());
    result.push_back(nullptr);
    return result;
}

struct Pipe {
    Descriptor out;  ///< read end
    Descriptor in;   ///< write end
};

/// The size of a pipe: frames of video need few context switches if it is large.
constexpr int kPipeBytes = 1 << 20;

std::optional<Pipe> make_pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
    static_cast<void>(::fcntl(ends[1], F_SETPIPE_SZ, kPipeBytes));
    return Pipe{Descriptor(ends[0]), Descriptor(ends[1])};
}

/// Writes to a pipe without SIGPIPE where nobody reads it any more.
ssize_t write_quietly(int to, std::string_view bytes) {
    sigset_t pipes{};
    sigset_t before{};
    ::sigemptyset(&pipes);
    ::sigaddset(&pipes, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &pipes, &before);
    const ssize_t written = ::write(to, bytes.data(), bytes.size());
    const int error = errno;
    const timespec now{};
    if (written < 0 && error == EPIPE) static_cast<void>(::sigtimedwait(&pipes, nullptr, &now));
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    errno = error;
    return written;
}

class Spawn {
public:
    Spawn() {
        ::posix_spawn_file_actions_init(&actions_);
        ::posix_spawnattr_init(&attributes_);
        // A process group, so that its children end with it.
        ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP);
    }
    Spawn(const Spawn&) = delete;
    Spawn& operator=(const Spawn&) = delete;
    ~Spawn() {
        ::posix_spawn_file_actions_destroy(&actions_);
        ::posix_spawnattr_destroy(&attributes_);
    }

    /// Connects a stream of the program to `end`, or to /dev/null without one.
    void connect(int stream, const Descriptor& end) {
        if (end)
            ::posix_spawn_file_actions_adddup2(&actions_, *end, stream);
        else
            ::posix_spawn_file_actions_addopen(&actions_, stream, "/dev/null",
                                               stream == STDIN_FILENO ? O_RDONLY : O_WRONLY, 0);
    }

    bool run(std::vector<std::string> words, std::vector<std::string> settings, pid_t& process) {
        return ::posix_spawn(&process, words[0].c_str(), &actions_, &attributes_,
                             pointers(words).data(), pointers(settings).data()) == 0;
    }

private:
    posix_spawn_file_actions_t actions_{};
    posix_spawnattr_t attributes_{};
};

}  // namespace

std::string helper_path(std::string_view name) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    const fs::path beside = folder / name;
    if (fs::exists(beside, error)) return beside.string();
    return (folder.parent_path() / "libexec" / "etlc" / name).string();
}

std::unique_ptr<Child> Child::start(const std::string& program,
                                    const std::vector<std::string>& arguments,
                                    const Options& options) {
    std::optional<Pipe> input = options.fed ? make_pipe() : Pipe();
    std::optional<Pipe> output = make_pipe();
    std::optional<Pipe> errors = options.heard ? make_pipe() : Pipe();
    if (!input || !output || !errors) return nullptr;
    Spawn spawn;
    spawn.connect(STDIN_FILENO, input->out);
    spawn.connect(STDOUT_FILENO, output->in);
    spawn.connect(STDERR_FILENO, errors->in);
    std::vector<std::string> words = {program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    pid_t process = 0;
    if (!spawn.run(std::move(words), environment(options), process)) return nullptr;
    if (options.fed) ::fcntl(*input->in, F_SETFL, O_NONBLOCK);
    return std::unique_ptr<Child>(new Child(process, options, std::move(input->in),
                                            std::move(output->out), std::move(errors->out)));
}

void Child::become(const std::string& program, const std::vector<std::string>& arguments,
                   const Options& options) {
    std::vector<std::string> words = {program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<std::string> settings = environment(options);
    ::execve(program.c_str(), pointers(words).data(), pointers(settings).data());
}

Child::~Child() {
    stop();
}

void Child::stop() {
    if (process_ == 0) return;
    ::kill(-process_, SIGKILL);
    status();
}

/// Waits for the end of a program that has closed its output or input; kills one that goes on.
int Child::status() {
    using namespace std::chrono;
    const auto deadline = steady_clock::now() + seconds(options_.max_silence_seconds);
    pid_t ended = 0;
    while (process_ != 0 && (ended = ::waitpid(process_, &status_, WNOHANG)) == 0) {
        if (steady_clock::now() >= deadline) {
            silent_ = true;
            ::kill(-process_, SIGKILL);
        }
        std::this_thread::sleep_for(milliseconds(1));
    }
    if (ended < 0) status_ = -1;
    process_ = 0;
    return status_;
}

bool Child::give(std::string_view bytes) {
    while (!bytes.empty())
        if (deaf_ || !wait(bytes)) return false;
    return true;
}

void Child::give_no_more() {
    input_ = Descriptor();
}

bool Child::read(char* to, std::size_t n) {
    std::string_view nothing;
    while (arrived() < n)
        if (!output_ || !wait(nothing)) return false;
    std::memcpy(to, arrived_.data() + taken_, n);
    taken_ += n;
    if (taken_ == arrived_.size()) {
        arrived_.clear();
        taken_ = 0;
    }
    return true;
}

bool Child::at_end() {
    std::string_view nothing;
    while (arrived() == 0)
        if (!output_ || !wait(nothing)) return true;
    return false;
}

bool Child::wait(std::string_view& bytes) {
    std::array<pollfd, 3> waiting{
        {{bytes.empty() ? -1 : *input_, POLLOUT, 0}, {*output_, POLLIN, 0}, {*errors_, POLLIN, 0}}};
    const int ready = ::poll(waiting.data(), waiting.size(), 1000 * options_.max_silence_seconds);
    if (ready < 0) return errno == EINTR;
    silent_ = ready == 0;
    if (silent_) return false;
    if (waiting[2].revents != 0) hear();
    if (waiting[1].revents != 0) receive();
    if (waiting[0].revents == 0) return true;
    const ssize_t written = write_quietly(*input_, bytes);
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
    deaf_ = written < 0 && errno != EAGAIN && errno != EINTR;
    return !deaf_;
}

std::size_t Child::take(char* to, std::size_t n) {
    std::size_t taken = std::min(n, arrived());
    if (taken > 0) read(to, taken);
    pollfd waiting{*output_, POLLIN, 0};
    while (taken < n && output_ && ::poll(&waiting, 1, 0) > 0) {
        const ssize_t got = uninterrupted([&] { return ::read(*output_, to + taken, n - taken); });
        if (got <= 0)
            output_ = Descriptor();
        else
            taken += static_cast<std::size_t>(got);
    }
    return taken;
}

void Child::await(const std::vector<Child*>& children, const std::vector<int>& others,
                  int milliseconds) {
    std::vector<pollfd> waiting;
    for (const Child* child : children) {
        waiting.push_back({*child->output_, POLLIN, 0});
        waiting.push_back({*child->errors_, POLLIN, 0});
    }
    for (const int other : others) waiting.push_back({other, POLLIN, 0});
    if (::poll(waiting.data(), waiting.size(), milliseconds) <= 0) return;
    for (std::size_t i = 0; i < children.size(); ++i) {
        if (waiting[2 * i + 1].revents != 0) children[i]->hear();
        if (waiting[2 * i].revents != 0) children[i]->receive();
    }
}

void Child::receive() {
    if (taken_ > 0) arrived_.erase(0, std::exchange(taken_, 0));
    const std::size_t before = arrived_.size();
    int ready = 0;
    if (::ioctl(*output_, FIONREAD, &ready) != 0 || ready <= 0) ready = 1;
    const auto piece = static_cast<std::size_t>(ready);
    arrived_.resize(before + piece);
    const ssize_t got =
        uninterrupted([&] { return ::read(*output_, arrived_.data() + before, piece); });
    arrived_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got <= 0) output_ = Descriptor();
}

void Child::hear() {
    constexpr std::size_t kKept = 2000;
    std::array<char, 4096> words{};
    const ssize_t got = uninterrupted([&] { return ::read(*errors_, words.data(), words.size()); });
    if (got <= 0) {
        errors_ = Descriptor();
        return;
    }
    said_.append(words.data(), static_cast<std::size_t>(got));
    if (said_.size() > kKept) said_.erase(0, said_.size() - kKept);
}

std::string Child::last_words() {
    while (errors_ && !silent_) {
        pollfd waiting{*errors_, POLLIN, 0};
        if (::poll(&waiting, 1, 1000) == 0) break;  // a grandchild may hold it open
        hear();
    }
    std::string_view text = said_;
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.remove_suffix(1);
    const std::size_t line = text.rfind('\n');
    std::string result(text.substr(line == std::string_view::npos ? 0 : line + 1));
    for (char& c : result)
        if (c < 0x20 || c == 0x7f) c = '?';
    return result;
}

std::string Child::ending() {
    if (silent_) stop();
    const int ended = status();
    if (silent_)
        return fmt::format("said nothing for {} seconds and was stopped",
                           options_.max_silence_seconds);
    if (ended >= 0 && WIFSIGNALED(ended))
        return fmt::format("was stopped by signal {} ({})", WTERMSIG(ended),
                           ::strsignal(WTERMSIG(ended)));
    return fmt::format("ended too soon, with exit status {}",
                       ended >= 0 && WIFEXITED(ended) ? WEXITSTATUS(ended) : -1);
}

int Child::exit_status() {
    if (silent_) stop();
    const int ended = status();
    return !silent_ && ended >= 0 && WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
}

}  // namespace etlc::data
