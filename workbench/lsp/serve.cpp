#include <poll.h>
#include <unistd.h>

#include <array>

#include "data/files/file.hpp"
#include "lsp/lsp.hpp"
#include "lsp/protocol/session.hpp"

namespace etlc::lsp {

namespace {

/// How long the client has to be quiet before its monitors are planned, in milliseconds.
constexpr int kPause = 250;

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
            bool ready = has_input(0);
            if (!ready) {
                session_.catch_up();
                ready = has_input(session_.has_idle_work() ? kPause : -1);
            }
            if (!ready)
                session_.do_idle_work();
            else if (!read_some())
                break;
        }
        session_.catch_up();
        return can_write_ ? session_.status_at_end() : 1;
    }

private:
    /// Waits for input, for so many milliseconds or, below zero, without end.
    bool has_input(int milliseconds) const {
        pollfd input{in_, POLLIN, 0};
        return data::uninterrupted([&] { return ::poll(&input, 1, milliseconds); }) != 0;
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
