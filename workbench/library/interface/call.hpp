// The message of the last call, and what all functions of the interface share.
// Keeps true: no exception leaves a function; a message of one line allocates no memory.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "check/model/model.hpp"
#include "library/batch.hpp"
#include "library/etlc.h"
#include "library/program.hpp"
#include "library/session.hpp"

namespace etlc::library {

class Message {
public:
    /// Returns the message of this thread.
    static Message& here() noexcept;

    const char* text() const { return text_; }
    const char* json() const { return json_; }
    void clear() noexcept;
    void take_diagnostics(std::string text, std::string json) noexcept;
    /// Stores the warnings of a call that succeeded.
    void take_warnings(std::string json) noexcept;

    /// Sets a message of one line, cut off at the size of its buffer.
    template <class... Arguments>
    etlc_status say(etlc_status status, fmt::format_string<Arguments...> format,
                    Arguments&&... arguments) {
        clear();
        const auto end = fmt::format_to_n(line_, sizeof line_ - 1, format,
                                          std::forward<Arguments>(arguments)...);
        *end.out = '\0';
        text_ = line_;
        return status;
    }
    /// Sets the message of the current exception.
    etlc_status say_what_failed() noexcept;

private:
    char line_[512] = "";
    std::string diagnostics_;
    std::string diagnostics_json_;
    const char* text_ = "";
    const char* json_ = "";
};

template <class... Arguments>
etlc_status refuse(etlc_status status, fmt::format_string<Arguments...> format,
                   Arguments&&... arguments) {
    return Message::here().say(status, format, std::forward<Arguments>(arguments)...);
}

/// Returns the status of `work`, which may throw.
template <class Work>
etlc_status guarded(const Work& work) noexcept {
    try {
        Message::here().clear();
        return work();
    } catch (...) {
        return Message::here().say_what_failed();
    }
}

/// Calls `work(held)` where the number stands for a session that no other thread uses.
template <class Work>
etlc_status with_held(etlc_session number, const Work& work) noexcept {
    return guarded([&]() -> etlc_status {
        Held held(number);
        if (held.state() == Held::State::held) return work(held);
        if (held.state() == Held::State::busy)
            return refuse(ETLC_BUSY,
                          "session {:#x} is in a call of another thread: a session is used by one "
                          "thread at a time",
                          number);
        return refuse(ETLC_NO_SESSION,
                      "session {:#x} is not open: it was closed, or never given by etlc_open()",
                      number);
    });
}

/// Calls `work(session)` in the same way, for a batch or not.
template <class Work>
etlc_status with_any(etlc_session number, const Work& work) noexcept {
    return with_held(number, [&](Held& held) -> etlc_status { return work(*held); });
}

/// Calls `work(session)` in the same way, for a session of one environment.
template <class Work>
etlc_status with_session(etlc_session number, const Work& work) noexcept {
    return with_any(number, [&](Session& opened) -> etlc_status {
        if (opened.batch() == nullptr) return work(opened);
        return refuse(ETLC_WRONG_VALUE,
                      "session {:#x} is a batch of {} environments: call the function for batches, "
                      "or etlc_copy_environment()",
                      number, opened.batch()->size());
    });
}

/// Calls `work(batch, session)` in the same way, for a batch.
template <class Work>
etlc_status with_batch(etlc_session number, const Work& work) noexcept {
    return with_any(number, [&](Session& opened) -> etlc_status {
        if (opened.batch() != nullptr) return work(*opened.batch(), opened);
        return refuse(ETLC_WRONG_VALUE, "session {:#x} is no batch: etlc_open_batch() opens one",
                      number);
    });
}

inline etlc_status refuse_null(const char* what) {
    return refuse(ETLC_NULL_POINTER, "{} is null", what);
}

inline etlc_status refuse_index(const char* what, std::uint64_t found, std::uint64_t count) {
    return refuse(ETLC_NO_SUCH, "there is no {} {}: the spec has {} of them", what, found, count);
}

/// Refuses a monitor that does not restart.
etlc_status check_restarts(const Session& session, std::uint32_t monitor);

/// Checks the struct_size that the caller has set.
inline etlc_status check_size(std::uint32_t found, std::size_t expected, const char* what) {
    if (found == expected) return ETLC_OK;
    return refuse(ETLC_WRONG_VERSION,
                  "struct_size of {} is {}, expected {}: set it to the sizeof of the struct, from "
                  "the etlc.h of this library",
                  what, found, expected);
}

/// Checks a struct of the caller, which must have the size of this version.
template <class Struct>
etlc_status check_struct(const Struct* given, const char* what) {
    if (given == nullptr) return refuse_null(what);
    return check_size(given->struct_size, sizeof(Struct), what);
}

// What is checked of samples in the memory of the caller.

/// Refuses samples that are not one per input. `what`: their name in the message.
etlc_status check_count(const Session& session, const void* samples, std::size_t count,
                        const char* what);

/// Refuses room for verdicts that is null, or larger than any memory.
etlc_status check_verdicts(const void* verdicts, std::size_t count);

/// Return ETLC_OK, or refuse the samples of an input. The room for the verdicts has been checked,
/// so that `rows` times `steps` is no number that the caller made up.
etlc_status check_sample(const check::Input& input, const etlc_sample& sample);
etlc_status check_grid(const check::Input& input, const etlc_grid& grid, std::uint64_t rows,
                       std::uint64_t steps);

// What the functions for rows of steps check.

constexpr std::uint64_t kMostRows = std::uint64_t{1} << 32U;
constexpr std::uint32_t kMostThreads = 1024;

/// Checks the samples of all inputs, the number of threads and the room for all verdicts.
etlc_status check_grids(const Session& session, const Grids& samples, std::size_t grid_count,
                        std::uint32_t threads, const void* verdicts, std::size_t count);

/// Refuses a batch where the episode of an environment has ended.
etlc_status check_none_ended(const Batch& batch);

/// Returns how many threads work at these rows.
inline std::uint32_t threads_for(std::uint32_t threads, const Grids& samples) {
    const std::uint64_t most = std::max<std::uint64_t>(samples.rows, 1);
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(threads, 1, most));
}

/// Opens the session that `make` makes.
template <class Make>
etlc_status give_session(etlc_session* to, const char* what, const Make& make) {
    if (to == nullptr) return refuse_null(what);
    *to = 0;
    *to = hold(make());
    return *to != 0 ? etlc_status{ETLC_OK}
                    : refuse(ETLC_OUT_OF_MEMORY, "too many sessions are open");
}

}  // namespace etlc::library
