// Trains a spec once for every fold of the labelled episodes: fit, calibrate, compile.
// Takes: a spec that lacks thresholds, and the episodes. Gives: per fold the spec compiled from the
// other folds. Keeps true: no episode of a fold contributes to its monitors; stages that may not
// share episodes get disjoint ones.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "diag/diag.hpp"
#include "driver/commands/request.hpp"
#include "evaluate/evaluate.hpp"

namespace etlc::driver {

struct Folds {
    std::uint32_t count = 0;
    std::vector<std::uint32_t> of;    ///< the fold of each episode, from 0
    bool in_order = false;            ///< a fold is judged by what the folds before it trained
    std::vector<std::size_t> order;   ///< the episodes in the order of their content
    thresholds::Allowance allowance;  ///< accepted overlaps between episodes

    /// Returns the first fold that is judged.
    std::uint32_t first() const { return in_order ? 1 : 0; }
    /// Returns whether an episode trains the monitors that judge a fold.
    bool trains(std::size_t episode, std::uint32_t fold) const {
        return in_order ? of[episode] < fold : of[episode] != fold;
    }
};

/// Judges every fold by monitors trained on the others. `folds` are dealt where there are none
/// yet, request.folds of them.
std::optional<evaluate::Judgement> judge_in_folds(const source::File& file,
                                                  const check::Model& model, const Request& request,
                                                  const evaluate::Request& asked,
                                                  std::optional<Folds>& folds, diag::Sink& sink);

}  // namespace etlc::driver
