// `etlc explain`: why a monitor says what it says about a recorded trace.
// Takes: a compiled spec, a trace file, and which verdict. Gives: the explanation, as text or JSON.
// Keeps true: without a choice it is the first alarm that is explained; the output file appears
// whole or not at all.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "data/recordings/open.hpp"
#include "diag/diag.hpp"
#include "driver/compile/compile.hpp"

namespace etlc::driver {

enum class ExplanationFormat : std::uint8_t { text, json };

struct ExplainRequest {
    std::string trace;
    data::NamesInFile names;
    std::string monitor;                ///< empty: the first with an alarm, else the first
    std::optional<std::uint64_t> step;  ///< after which the verdict was given
    std::optional<double> at;           ///< the same in seconds
    ExplanationFormat format = ExplanationFormat::text;
    std::string output = "-";
};

/// False where the sink now says why not.
bool explain(const source::File& spec, const Compiled& compiled, const ExplainRequest& request,
             diag::Sink& sink);

}  // namespace etlc::driver
