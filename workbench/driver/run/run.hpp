// `etlc run`: the plan, executed on a recorded trace.
// Takes: a compiled spec and a trace file. Gives: one CSV row per step and monitor, or a summary.
// Keeps true: constant memory and linear time; the output file appears whole or not at all.
#pragma once

#include <string>

#include "data/recordings/open.hpp"
#include "diag/diag.hpp"
#include "driver/compile/compile.hpp"

namespace etlc::driver {

struct RunRequest {
    std::string trace;
    data::NamesInFile names;
    /// Of the rows; empty: none are written.
    std::string output = "-";
    /// A line for each monitor, and for each input with missing samples, on standard output.
    bool summary = false;
    /// Beside the columns of lets, which the plan has: one for each predicate, the distance, or
    /// expression, that it compares.
    bool distances = false;
    std::string html;  ///< a page of the trace to look at; empty: not asked for
    std::string svg;   ///< a picture of its timelines
    /// Also the positions that sliding monitors report after the end of the trace.
    bool finish = false;
};

/// False where the sink now says why not.
bool run(const source::File& spec, const Compiled& compiled, const RunRequest& request,
         diag::Sink& sink);

}  // namespace etlc::driver
