// Numbers that earlier steps have a part in, in double, for truths. The work of a step does not
// depend on the length of a window.
#pragma once

#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::episodes {

class PastValues {
public:
    explicit PastValues(const check::Past& past) : past_(&past) {}

    void reset();
    /// Takes the value of its expression at this frame, NaN where it is missing. Returns the
    /// number, NaN while a value that it is made of is missing.
    double push(double value);

private:
    void add(double value, double sign);
    double mean() const;
    double extreme(double value);

    const check::Past* past_;
    std::deque<double> values_;  ///< the last ones, none of which a window lacks
    std::size_t frame_ = 0;
    /// For a min or max: the values that may still be it, with their frames; the first is it now.
    std::deque<std::pair<std::size_t, double>> candidates_;
    std::vector<double> sum_;  ///< of a mean: its exact parts, small ones first, without infinities
    std::size_t above_ = 0;    ///< infinities in the window
    std::size_t below_ = 0;
};

}  // namespace etlc::episodes
