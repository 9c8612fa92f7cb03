// `etlc watch`: steps the monitors of a spec with what happens now, and says what changes.
// Takes: a camera, a stream, a video, or a trace on standard input. Gives: a line for each change,
// a page, and files of incidents. Keeps true: whatever ends it (the source, Ctrl-C, an error), the
// incidents so far are in files and the summary is printed.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"
#include "embed/encoder.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "execute/flight_recorder.hpp"
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

/// The files of incidents: the steps around each alarm, as the flight recorder of a generated class
/// writes them.
/// Keeps true: an alarm is in a file before anybody reads of it, with the steps before; the steps
/// behind it follow. No earlier file is replaced.
class Incidents {
public:
    /// `plan`: with a recorder. `folder`: it exists.
    Incidents(const plan::Plan& plan, std::string folder);

    /// Records a step, and writes the incidents that it begins or completes. Returns why they
    /// cannot be written; the next step tries again.
    std::optional<diag::Diagnostic> step(const execute::Evaluator& evaluator,
                                         const std::vector<etlmon::Verdict>& verdicts);
    /// Writes those that wait for more steps as they are.
    std::optional<diag::Diagnostic> close();

    /// Returns "3 incidents in FOLDER".
    std::string text() const;

private:
    std::string path(std::uint64_t number) const;
    std::optional<diag::Diagnostic> write(execute::FlightRecorder& recorder,
                                          std::uint32_t incident);
    bool begins(const std::vector<etlmon::Verdict>& verdicts);
    std::optional<diag::Diagnostic> write_complete();

    const plan::Plan& plan_;
    std::string folder_;
    execute::FlightRecorder recorder_;
    std::vector<bool> alarms_;   ///< per monitor: at the last step
    bool is_noted_ = true;       ///< all incidents so far have a file
    std::uint32_t begun_ = 0;    ///< in the recorder
    std::uint32_t written_ = 0;  ///< of these, complete and in their files
    std::vector<std::uint64_t>
        numbers_;               ///< of those in the recorder that have a file, in its name
    std::uint64_t next_ = 0;    ///< number of the next one, unless another call takes it
    std::uint64_t before_ = 0;  ///< complete ones before this filling of the recorder
    std::uint64_t lost_ = 0;    ///< alarms that had no room, before this filling
};

}  // namespace etlc::watch
