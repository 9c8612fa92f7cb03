// The order of the assignments of a step.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "plan/program/reading.hpp"

namespace etlc::plan {

/// Puts assignments that store registers for the next step among those of this step: each as soon
/// as nothing reads the old value any more, so that few values wait at a time. (Otherwise g++ takes
/// time in proportion to the square of their number.)
class Schedule {
public:
    /// `assignments`: those of this step, in order.
    explicit Schedule(std::vector<Assignment> assignments);

    /// Stores a value after all that read the old one: the assignments of this step, and the stores
    /// that were added before.
    void add(const Term& to, Term value);

    std::vector<Assignment> end();

private:
    using Variable = std::pair<Term::Kind, std::uint32_t>;
    using Times = std::map<Variable, std::size_t>;

    void read_by(const Term& variable, std::size_t time);

    std::vector<Assignment> steps_;
    std::vector<std::vector<Assignment>> stores_;  ///< before the first step, and after each
    Times read_until_;
    Times assigned_at_;
};

}  // namespace etlc::plan
