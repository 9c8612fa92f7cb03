// The labels of a predicate in an episode, and what a key does to them.
// Takes: the labels before, the key, and the step under the cursor. Gives: the labels after. Keeps
// true: intervals are sorted, none is empty or beyond the episode, and no two overlap. An interval
// that begins before another one touches it until the next key, which may be its end.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "episodes/labels/label.hpp"

namespace etlc::label {

/// Steps from `start` up to but excluding `end`, at which the predicate holds, or nobody knows.
struct Interval {
    std::uint64_t start = 0;
    std::uint64_t end = 0;
    episodes::Label label = episodes::Label::yes;

    bool operator==(const Interval&) const = default;
};

/// The intervals of a predicate; it is false elsewhere. Nothing: nobody has labelled it.
using Marks = std::optional<std::vector<Interval>>;

enum class Key : std::uint8_t {
    begin,    ///< it holds from this step on
    end,      ///< it holds up to and including this step
    unknown,  ///< nobody knows about the interval at this step, or somebody does again
    remove,   ///< the interval at this step goes
    never,    ///< it holds at no step
    forget    ///< nobody has looked
};

/// Returns the key of "begin", "end", ...
std::optional<Key> key_named(std::string_view word);

/// Returns the intervals with those joined that touch and have the same label.
std::vector<Interval> joined(const std::vector<Interval>& intervals);

/// Returns the labels after a key. `step` is less than `steps`, the length of the episode.
Marks after_key(const Marks& before, Key key, std::uint64_t step, std::uint64_t steps);

}  // namespace etlc::label
