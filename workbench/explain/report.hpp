// An explanation for people, and for programs.
// Takes: the explanation with what it was asked about. Gives: text, or JSON, whose keys
// docs/explanations.md lists. Keeps true: samples in a row are one interval.
#pragma once

#include <string>
#include <vector>

#include "etlmon/temporal/verdict.hpp"
#include "explain/explain.hpp"

namespace etlc::explain {

struct Report {
    const Observations& observations;
    Question question;
    bool is_final = false;
    Explanation explanation;
};

/// Of the monitor's verdict, which is `verdict`. Throws std::logic_error where the explanation is
/// of another one.
Report report(const Observations& observations, const ir::Program& program,
              const Question& question, const etlmon::Verdict& verdict);

std::string text(const Report& report);
std::string json(const Report& report);

// ---- what both are made of ----------------------------------------------------------------------

/// Samples of one atom at steps in a row, at which it holds, or fails.
struct Interval {
    Index atom = 0;
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    bool holds = false;
    bool is_missing = false;    ///< the spec says what they count as
    std::uint64_t closest = 0;  ///< the step of the least margin
};

/// By atom, then step.
std::vector<Interval> intervals(const Observations& observations,
                                const std::vector<Sample>& samples);

std::string name_of(const Observations& observations, Index atom);
const char* word(Status status);
/// How far from its threshold a predicate was measured.
float margin(const Observations& observations, Sample sample);

/// The row that was nearest then by a distance of the predicate that takes the minimum.
struct Nearest {
    const check::Distance* distance = nullptr;
    std::uint32_t row = 0;
};
std::vector<Nearest> nearest(const Observations& observations, Sample sample);

}  // namespace etlc::explain
