// How well a distance tells frames apart, whatever the threshold: the area under the ROC curve.
// Takes: a score and a label per frame, and the episode it is of. Gives: the probability that a
// positive frame scores higher than a negative one, ties counted half (Mann-Whitney). Keeps true:
// exact, no binning; only frames of the same fold are compared, whose scores are of one scale.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace etlc::evaluate {

struct Scored {
    float score = 0;  ///< the greater, the more likely positive
    std::uint32_t episode = 0;
    bool positive = false;
};

template <class Archive>
void fields(Archive& archive, Scored& frame) {
    archive(frame.score, frame.episode, frame.positive);
}

class Ranking {
public:
    /// `folds`: of each episode; empty: all are of one.
    explicit Ranking(std::vector<Scored> frames, const std::vector<std::uint32_t>& folds = {});

    /// With each episode's frames counted `weights[episode]` times; nothing where one of the
    /// classes is empty.
    std::optional<double> auroc(const std::vector<std::uint32_t>& weights) const;

private:
    std::vector<Scored> frames_;       ///< by fold, then by score
    std::vector<std::size_t> begins_;  ///< of each fold in them; at last their number
};

}  // namespace etlc::evaluate
