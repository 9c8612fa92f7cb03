#include "lsp/spec/planner.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <system_error>
#include <utility>

namespace etlc::lsp {

namespace {

std::unique_ptr<Planned> plan(const check::Inspected& checked) {
    auto result = std::make_unique<Planned>();
    result->compiled = pipeline::compile(check::Model(checked.model), {}, result->sink);
    return result;
}

/// Makes a pipe readable when it goes, also where planning throws.
class Bell {
public:
    explicit Bell(int to) : to_(to) {}
    Bell(const Bell&) = delete;
    Bell& operator=(const Bell&) = delete;
    ~Bell() { data::write_all(to_, "\n"); }

private:
    int to_;
};

}  // namespace

Planner::Planner() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        throw std::system_error(errno, std::generic_category(), "a pipe");
    ready_ = data::Descriptor(ends[0]);
    done_ = data::Descriptor(ends[1]);
}

void Planner::start(Checked checked) {
    checked_ = std::move(checked);
    try {
        plan_ = std::async(std::launch::async, [checked = checked_, done = *done_] {
            const Bell at_end(done);
            return plan(*checked);
        });
    } catch (const std::system_error&) {
        plan_ = std::async(std::launch::deferred, [checked = checked_] { return plan(*checked); });
        const Bell at_once(*done_);
    }
}

std::unique_ptr<Planned> Planner::take() {
    char byte = 0;
    data::uninterrupted([&] { return ::read(*ready_, &byte, 1); });
    checked_.reset();
    return plan_.get();
}

}  // namespace etlc::lsp
