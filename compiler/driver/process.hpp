// What the system gives a process: its standard streams, its signals.
// Keeps true: nothing here throws; what an input, an output or the system does, ends no process of ours by a signal but
// SIGPIPE, which ends it quietly when nobody reads its output any more, as is usual.
#pragma once

#include <string_view>

namespace etlc::driver {

/// To be called before a file is opened. Takes the standard descriptors that are closed, so that no file of ours gets
/// their numbers: standard output then cannot be written, what goes to standard error vanishes. A file that grows
/// beyond its limit is an error and no signal.
void prepare_process();

/// On standard error. False where not all of it can be written.
bool print_error(std::string_view text);

}  // namespace etlc::driver
