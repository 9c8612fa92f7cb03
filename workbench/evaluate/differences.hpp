// Two specs on the same episodes: how much their figures differ.
// Takes: what each said of them, and what was true. Gives: per predicate and per monitor that both
// have by name, the second's figures less the first's. Keeps true: intervals are of the
// differences, over the same resamples of the episodes for both, since what is hard for one is
// mostly hard for the other; where the two are held to different truths, nothing is compared.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/bootstrap.hpp"

namespace etlc::evaluate {

struct Judgement;

struct Difference {
    bool of_monitor = false;
    std::string name;
    std::string level;               ///< frames, steps, episodes
    std::uint64_t other_truths = 0;  ///< episodes whose truth differs; then there are no figures
    Figure f1;
    Figure precision;
    Figure recall;
    Figure agreement;
    std::optional<Figure> auroc;  ///< of predicates
};

std::vector<Difference> differences(const Judgement& first, const Judgement& second);

}  // namespace etlc::evaluate
