// `etlc evaluate` and `etlc crossvalidate`: specs and labelled episodes in, tables out.
// Takes: the specs' texts; their thresholds, or folds of the episodes from which they are taken.
// Gives: a table on standard output, unless another form goes there, and the files asked for. Keeps
// true: files appear whole or not at all; nothing is written where an episode was wrong; an episode
// is judged by monitors that have not seen it.
#pragma once

#include <cstdint>
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
    bool by_episode = false;       ///< also a row an episode; in CSV only these
    std::uint32_t folds = 0;       ///< 0: none, the spec's thresholds are there
    evaluate::Request evaluation;  ///< its episodes and progress are set here
};

/// A spec and what is found in it.
struct SpecToJudge {
    const source::File& file;
    diag::Sink& sink;
};

/// False where a sink now says why not. Thresholds are looked for beside each spec, where the
/// request names no file.
bool evaluate(const std::vector<SpecToJudge>& specs, const Request& request,
              const EvaluateRequest& evaluation);

}  // namespace etlc::driver
