// What is explained: a monitor's formula at a position of a prefix, and what its values come to.
#pragma once

#include <optional>
#include <vector>

#include "explain/explain.hpp"
#include "explain/values.hpp"

namespace etlc::explain {

struct Subject {
    const ir::Graph& graph;
    const Observations& observations;
    NodeId root = 0;
    std::vector<bool> nodes;  ///< below the root, and of all that the formula is written with
    std::uint64_t position = 0;
    std::uint64_t last = 0;  ///< of the prefix
    float shift = 0;         ///< what the verdict is less by

    /// Whether a key, pessimistic or optimistic as the status takes it, speaks for the status.
    bool supports(Status status, etlmon::Key key) const;
};

struct Judged {
    Status status = Status::unknown;
    Reading reading = Reading::so_far;  ///< whether the status is there for good
    /// Those that decide it: the pessimistic ones where satisfied, else the optimistic ones.
    Values values;
    Sourced root;
};
Judged judge(const Subject& subject, const std::optional<Altered>& altered = std::nullopt);

/// The end that decides: see Judged.
End deciding_end(Status status);

/// The smallest change of one measurement behind the samples that turns the verdict; a bool's only
/// where no other does. The values are altered meanwhile.
std::optional<Change> smallest_change(const Subject& subject, Judged& judged,
                                      const std::vector<Sample>& samples);

}  // namespace etlc::explain
