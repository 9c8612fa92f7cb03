// The end that somebody asks for: Ctrl-C, `kill`, or a terminal that is closed.
// Keeps true: the first signal only asks; a second one ends the process at once.
#pragma once

namespace etlc::watch {

class Stop {
public:
    /// `ends_input`: standard input is at its end once somebody has asked, so that what reads it
    /// does not wait any more.
    explicit Stop(bool ends_input);
    Stop(const Stop&) = delete;
    Stop& operator=(const Stop&) = delete;
    ~Stop();

    bool is_asked() const;
    /// A descriptor that can be read once somebody has asked.
    int descriptor() const;
};

}  // namespace etlc::watch
