// The numbers that stand for sessions.
// Keeps true: a number is never reused, so closed and invalid numbers are detected; looking one up
// takes no lock and allocates no memory.
#pragma once

#include <cstdint>
#include <memory>

#include "library/session.hpp"

namespace etlc::library {

struct Slot;

/// A session in use by this thread, or the reason that there is none.
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
    /// Removes the session from its number.
    std::unique_ptr<Session> close();

private:
    Slot* slot_ = nullptr;
    Session* session_ = nullptr;
    State state_ = State::absent;
};

/// Stores a session and returns its number; 0 where there are too many.
std::uint64_t hold(std::unique_ptr<Session> session);

}  // namespace etlc::library
