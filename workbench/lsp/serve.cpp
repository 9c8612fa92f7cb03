#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string_view>

#include "lsp/lsp.hpp"
#include "lsp/protocol/reader.hpp"
#include "lsp/protocol/session.hpp"

namespace etlc::lsp {

namespace {

/// False where nobody reads any more.
bool write_all(int out, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = write(out, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

enum class Ready : std::uint8_t { input, nothing, broken };

Ready wait_for(int in, int milliseconds) {
    pollfd descriptor{in, POLLIN, 0};
    while (true) {
        const int ready = poll(&descriptor, 1, milliseconds);
        if (ready < 0 && errno == EINTR) continue;
        if (ready < 0) return Ready::broken;
        return ready == 0 ? Ready::nothing : Ready::input;
    }
}

class Service {
public:
    Service(int in, int out)
        : in_(in), session_([this, out](const Json& message) {
              can_write_ = can_write_ && write_all(out, framed(message));
          }) {}

    int run() {
        while (can_write_) {
            while (auto frame = reader_.next()) {
                session_.receive(*frame);
                if (const auto status = session_.exit_status()) return *status;
            }
            // What came meanwhile is read before the present state is looked at.
            const Ready ready = wait_for(in_, 0);
            if (ready == Ready::nothing) {
                session_.catch_up();
                if (!rest()) continue;
            }
            if (!read_some()) return end();
        }
        return 1;
    }

private:
    /// Waits for more input; false where there is none yet.
    bool rest() {
        const bool has_work = session_.has_idle_work();
        if (wait_for(in_, has_work ? static_cast<int>(session_.pause().count()) : -1) !=
            Ready::nothing)
            return true;
        session_.do_idle_work();
        return false;
    }

    /// False at the end of the input.
    bool read_some() {
        std::array<char, 65536> bytes{};
        ssize_t count = 0;
        do count = read(in_, bytes.data(), bytes.size());
        while (count < 0 && errno == EINTR);
        if (count <= 0) return false;
        reader_.add({bytes.data(), static_cast<std::size_t>(count)});
        return true;
    }

    int end() {
        session_.catch_up();
        return can_write_ ? session_.status_at_end() : 1;
    }

    int in_;
    bool can_write_ = true;
    Reader reader_;
    Session session_;
};

}  // namespace

int serve(int in, int out) {
    return Service(in, out).run();
}

}  // namespace etlc::lsp
