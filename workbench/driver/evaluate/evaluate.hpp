// `etlc evaluate` and `etlc crossvalidate`: specs and labelled episodes in, tables out.
// Takes: the specs' texts; their thresholds, or folds of the episodes from which they are taken.
// Gives: a table on standard output, unless another form goes there, and the files asked for. Keeps
// true: files appear whole or not at all; nothing is written where an episode was wrong; an episode
// is judged by monitors that have not seen it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "diag/diag.hpp"
#include "driver/compile/compile.hpp"
#include "driver/fleet/fleet.hpp"
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
    ShardRequest shard;
};

/// A spec and what is found in it.
struct SpecToJudge {
    const source::File& file;
    diag::Sink& sink;
};

/// The file that the spec's thresholds were read from; nothing where nothing is calibrated.
std::optional<thresholds::File> thresholds_of(const check::Model& model, const std::string& spec,
                                              const Request& request);

/// A compiled spec, judged by the thresholds that it has. Nothing where the sink now says why.
std::optional<evaluate::Judgement> judge_as_it_is(const Compiled& compiled, const std::string& spec,
                                                  const Request& request,
                                                  const evaluate::Request& asked, diag::Sink& sink);

/// False where a sink now says why not. Thresholds are looked for beside each spec, where the
/// request names no file.
bool evaluate(const std::vector<SpecToJudge>& specs, const Request& request,
              const EvaluateRequest& evaluation);

}  // namespace etlc::driver
