// The episodes one by one, worst first: figures over all of them hide a recording session on which
// a monitor fails. Takes: what was said and what was true. Gives: a row per episode. Keeps true:
// worse is an episode with more wrong verdicts of monitors, of equals the one on which predicates
// are wrong about a greater share of the frames, of equals the earlier one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluate/counts.hpp"

namespace etlc::evaluate {

struct Judgement;

struct EpisodeRow {
    /// The first step at which something disagrees with a known truth: a predicate, else a monitor.
    struct Error {
        std::uint64_t step = 0;  ///< of a sliding monitor the position
        std::string name;
        bool of_monitor = false;
    };
    std::string path;
    std::optional<std::uint32_t> fold;  ///< from 1 on, where there are folds
    std::uint64_t frames = 0;
    std::vector<std::string> wrong;  ///< monitors whose verdict on the episode is not the true one
    /// By frames, of all labelled predicates; without any by steps, of all monitors.
    Counts claims;
    std::optional<Error> first_error;
    std::vector<std::pair<std::string, Counts>> predicates;  ///< by frames
};

std::vector<EpisodeRow> by_episode(const Judgement& judgement);

}  // namespace etlc::evaluate
