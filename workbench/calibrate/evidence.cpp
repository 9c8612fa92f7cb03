#include "calibrate/evidence.hpp"

namespace etlc::calibrate {

void Evidence::add(const Scores& scores) {
    const auto demonstration = static_cast<std::uint32_t>(demonstrations++);
    from_array += scores.from_array ? 1 : 0;
    positives += scores.positives;
    negatives += scores.negatives;
    unlabelled += scores.unlabelled;
    unmeasured += scores.unmeasured;
    if (scores.has_score) worst.push_back({scores.worst_reach, demonstration});
    for (const double reach : scores.reaches) reaches.add({reach, demonstration});
    for (const Scores::Labelled& frame : scores.labelled)
        labelled.add({frame.score, demonstration, frame.positive});
}

}  // namespace etlc::calibrate
