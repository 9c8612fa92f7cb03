// `etlc watch`: steps the monitors of a spec with what happens now, and says what changes.
// Takes: a camera, a stream, a video, or a trace on standard input. Gives: a line for each change,
// a page, and files of incidents. Keeps true: whatever ends it (the source, Ctrl-C, an error), the
// incidents so far are in files and the summary is printed.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "diag/diag.hpp"
#include "embed/encoder.hpp"
#include "plan/program/program.hpp"
#include "recordings/open.hpp"

namespace etlc::watch {

struct Request {
    std::string video;  ///< path or address; empty: the trace on standard input
    recordings::NamesInFile names;
    embed::Running running;
    std::string version;  ///< of etlc
    bool has_page = false;
    std::uint32_t port = 0;  ///< 0: any free one
    std::string spec_path;
    std::string record;  ///< folder of incidents, where the plan has a recorder; empty: none
    /// Prints to standard output at once; false where that fails, which it has reported.
    std::function<bool(std::string_view)> print;
};

/// Watches until the source ends or somebody asks for the end. Returns false after an error, which
/// it reports.
bool watch(const plan::Plan& plan, const Request& request, diag::Sink& sink);

// The end that somebody asks for: Ctrl-C, `kill`, or a terminal that is closed.
// Keeps true: the first signal only asks; a second one ends the process at once.

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
