// What a call says of its failure, and the line that no exception crosses.
// Takes: a function of the interface. Gives: its status, with the message of its thread. Keeps
// true: a message of one line asks for no memory.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "library/etlc.h"

namespace etlc::library {

class Message {
public:
    /// Of this thread.
    static Message& here() noexcept;

    const char* text() const { return text_; }
    const char* json() const { return json_; }
    void clear() noexcept;
    void take_diagnostics(std::string text, std::string json) noexcept;
    /// Of a call that did not fail.
    void take_warnings(std::string json) noexcept;

    /// A line, cut off where it is longer than there is room for.
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
    /// What the exception means that is being handled.
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

/// The status of `work`, which may throw.
template <class Work>
etlc_status guarded(const Work& work) noexcept {
    try {
        Message::here().clear();
        return work();
    } catch (...) {
        return Message::here().say_what_failed();
    }
}

}  // namespace etlc::library
