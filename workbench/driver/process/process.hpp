// What the system gives a process: its standard streams, its signals.
// Keeps true: nothing here throws; what an input, an output or the system does, ends no process of
// ours by a signal but SIGPIPE, which ends it quietly when nobody reads its output any more, as is
// usual.
#pragma once

#include <string_view>

namespace etlc::driver {

// The exit statuses of etlc.
inline constexpr int kDone = 0;
inline constexpr int kFailed =
    1;  ///< a diagnostic says why: a wrong spec, or what a process can lack
inline constexpr int kWrongCall = 2;
inline constexpr int kOwnFault = 3;  ///< of etlc

/// To be called before a file is opened. Takes the standard descriptors that are closed, so that no
/// file of ours gets their numbers: standard output then cannot be written, what goes to standard
/// error vanishes. A file that grows beyond its limit is an error and no signal.
void prepare_process();

/// Says what the exception that is being handled means, without memory of its own. Gives: the exit
/// status. Takes part where nobody can catch one any more, too: prepare_process() makes it what
/// std::terminate calls.
int say_what_failed() noexcept;

/// On standard error. False where not all of it can be written.
bool print_error(std::string_view text);

}  // namespace etlc::driver
