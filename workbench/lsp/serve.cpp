#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>

#include "data/files/descriptor.hpp"
#include "lsp/lsp.hpp"
#include "lsp/protocol/reader.hpp"
#include "lsp/protocol/session.hpp"

namespace etlc::lsp {

namespace {

/// How long the client has to be quiet before its monitors are planned, in milliseconds.
constexpr int kPause = 250;

enum class Ready : std::uint8_t { input, plan, nothing, broken };

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
            Ready ready = wait(0);
            if (ready == Ready::nothing) {
                session_.catch_up();
                ready = wait(session_.has_idle_work() ? kPause : -1);
            }
            if (ready == Ready::nothing)
                session_.do_idle_work();
            else if (ready == Ready::plan)
                session_.take_plan();
            else if (!read_some())
                return end();
        }
        return 1;
    }

    bool is_planning() const { return session_.is_planning(); }

private:
    /// Waits for input first of all.
    Ready wait(int milliseconds) {
        std::array<pollfd, 2> descriptors{{{in_, POLLIN, 0}, {session_.has_plan(), POLLIN, 0}}};
        const int ready = data::uninterrupted(
            [&] { return ::poll(descriptors.data(), descriptors.size(), milliseconds); });
        if (ready < 0) return Ready::broken;
        if (ready == 0) return Ready::nothing;
        return descriptors[0].revents != 0 ? Ready::input : Ready::plan;
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
        session_.end();
        return can_write_ ? session_.status_at_end() : 1;
    }

    int in_;
    bool can_write_ = true;
    Reader reader_;
    Session session_;
};

}  // namespace

int serve(int in, int out) {
    Service service(in, out);
    const int status = service.run();
    // A plan in work cannot be stopped, and nobody waits for it. Its thread must not see how the
    // process ends.
    if (service.is_planning()) std::_Exit(status);
    return status;
}

}  // namespace etlc::lsp
