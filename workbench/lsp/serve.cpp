#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdint>

#include "data/files/descriptor.hpp"
#include "lsp/lsp.hpp"
#include "lsp/protocol/reader.hpp"
#include "lsp/protocol/session.hpp"

namespace etlc::lsp {

namespace {

enum class Ready : std::uint8_t { input, nothing, broken };

Ready wait_for(int in, int milliseconds) {
    pollfd descriptor{in, POLLIN, 0};
    const int ready = data::uninterrupted([&] { return ::poll(&descriptor, 1, milliseconds); });
    if (ready < 0) return Ready::broken;
    return ready == 0 ? Ready::nothing : Ready::input;
}

class Service {
public:
    Service(int in, int out)
        : in_(in), session_([this, out](const Json& message) {
              can_write_ = can_write_ && data::write_all(out, framed(message));
          }) {}

    int run() {
        while (can_write_) {
            while (auto frame = reader_.next()) {
                session_.receive(*frame);
                if (const auto status = session_.exit_status()) return *status;
            }
            // Read waiting messages before the present state is analysed.
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
    /// Waits for more input; false where it did idle work instead.
    bool rest() {
        const bool has_work = session_.has_idle_work();
        if (wait_for(in_, has_work ? static_cast<int>(session_.pause().count()) : -1) !=
            Ready::nothing)
            return true;
        session_.do_idle_work();
        return false;
    }

    /// Reads some input; false at its end.
    bool read_some() {
        std::array<char, 65536> bytes{};
        const ssize_t count =
            data::uninterrupted([&] { return ::read(in_, bytes.data(), bytes.size()); });
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
