// Prints an explanation as text, or as JSON, whose keys docs/explanations.md lists. Samples at
// consecutive steps are one interval.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "etlmon/temporal/verdict.hpp"
#include "explain/explain.hpp"

namespace etlc::explain {

/// The verdicts of a monitor at every step of a trace.
struct History {
    std::vector<etlmon::Verdict> verdicts;
    std::vector<std::uint64_t> positions;  ///< the positions they judge
    std::optional<std::uint64_t> first_alarm;
    std::optional<std::uint64_t> first_final;

    void add(const etlmon::Verdict& verdict, std::uint64_t position) {
        if (verdict.alarm() && !first_alarm) first_alarm = verdicts.size();
        if (verdict.final() && !first_final) first_final = verdicts.size();
        add_after_trace(verdict, position);
    }
    void add_after_trace(const etlmon::Verdict& verdict, std::uint64_t position) {
        verdicts.push_back(verdict);
        positions.push_back(position);
    }

    /// Returns the step to explain by default: the first alarm; else the first final verdict of a
    /// prefix monitor; else the last frame.
    std::uint64_t usual_step(bool sliding, std::uint64_t last_frame) const {
        if (first_alarm) return *first_alarm;
        return first_final && !sliding ? *first_final : last_frame;
    }
};

struct Report {
    const Observations& observations;
    Question question;
    bool is_final = false;
    Explanation explanation;
};

/// Explains `verdict`. Throws std::logic_error where the explanation is of another one.
Report report(const Observations& observations, const ir::Program& program,
              const Question& question, const etlmon::Verdict& verdict);

std::string text(const Report& report);
std::string json(const Report& report);

/// Samples of one atom at consecutive steps, all true or all false.
struct Interval {
    Index atom = 0;
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    bool holds = false;
    bool is_missing = false;    ///< counted as the spec's `missing` says
    std::uint64_t closest = 0;  ///< the step of the least margin
};

/// Groups samples, sorted by atom, then step.
std::vector<Interval> intervals(const Observations& observations,
                                const std::vector<Sample>& samples);

const char* word(Status status);

}  // namespace etlc::explain
