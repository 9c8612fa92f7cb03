// Prints the output of the demo: a line per drive, then how often the monitors agree with the
// truth.
// Keeps true: colour only on a terminal (and not if NO_COLOR is set); widths do not depend on it.
#pragma once

#include <array>
#include <cstddef>

#include "monitoring.hpp"
#include "score.hpp"

namespace demo {

class Report {
public:
    Report();

    void header() const;
    /// Prints the line of one drive and counts it.
    void add(const Recording& recording);
    void summary() const;

private:
    bool colour_;
    std::size_t drives_ = 0;
    std::array<Score, kMonitors.size()> at_end_;    ///< one count per drive
    std::array<Score, kMonitors.size()> at_steps_;  ///< one count per step
    std::array<Score, kPredicates.size()> frames_;
};

}  // namespace demo
