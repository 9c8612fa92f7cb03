// `etlc evaluate`: spec, thresholds and labelled episodes in, tables out.
// Takes: the spec's text. Gives: a table on standard output, unless another form goes there, and
// the files asked for. Keeps true: files appear whole or not at all; nothing is written where an
// episode was wrong.
#pragma once

#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "driver/compile.hpp"
#include "evaluate/evaluate.hpp"

namespace etlc::driver {

struct EvaluateRequest {
    std::vector<std::string> data;  ///< files, folders and patterns
    std::string groups;             ///< of .h5 files that are episodes
    std::string json;               ///< path; empty: not asked for
    std::string csv;
    evaluate::Request evaluation;  ///< its episodes and progress are set here
};

/// False where the sink now says why not.
bool evaluate(const source::File& file, const Request& request, const EvaluateRequest& evaluation,
              diag::Sink& sink);

}  // namespace etlc::driver
