// Which sessions are open.
// Takes: a session. Gives: the number that stands for it, and the session of a number, for one
// caller at a time. Keeps true: a number is given once, so that one which is closed, or was never
// given, is known to be; looking one up takes no lock and asks for no memory.
#pragma once

#include <cstdint>
#include <memory>

#include "library/session.hpp"

namespace etlc::library {

struct Slot;

/// A session in use by this thread, or why there is none.
class Held {
public:
    enum class State : std::uint8_t { held, absent, busy };

    explicit Held(std::uint64_t number) noexcept;
    ~Held();
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;

    State state() const { return state_; }
    Session* operator->() const { return session_; }
    Session& operator*() const { return *session_; }
    /// The number stands for nothing from now on.
    std::unique_ptr<Session> close();

private:
    Slot* slot_ = nullptr;
    Session* session_ = nullptr;
    State state_ = State::absent;
};

/// The number; 0 where there are too many.
std::uint64_t hold(std::unique_ptr<Session> session);

}  // namespace etlc::library
