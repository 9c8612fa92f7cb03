#include "label/marks.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace etlc::label {

namespace {

using episodes::Label;
using Intervals = std::vector<Interval>;

/// Returns the first interval that ends after the step: the one at it, or the next one.
Intervals::iterator at_or_after(Intervals& intervals, std::uint64_t step) {
    return std::find_if(intervals.begin(), intervals.end(),
                        [&](const Interval& one) { return one.end > step; });
}

/// Moves the beginning of the interval at this step. Without one, a new interval lasts up to the
/// next, so that no later mark is lost.
void begin_at(Intervals& intervals, std::uint64_t step, std::uint64_t steps) {
    const auto found = at_or_after(intervals, step);
    if (found != intervals.end() && found->start <= step)
        found->start = step;
    else
        intervals.insert(found, {step, found == intervals.end() ? steps : found->start});
}

/// Moves the end of the interval at this step, or of the last one before it. Without one, it held
/// from the beginning on.
void end_at(Intervals& intervals, std::uint64_t step) {
    const auto found = at_or_after(intervals, step);
    if (found != intervals.end() && found->start <= step)
        found->end = step + 1;
    else if (found != intervals.begin())
        std::prev(found)->end = step + 1;
    else
        intervals.insert(found, {0, step + 1});
}

}  // namespace

std::optional<Key> key_named(std::string_view word) {
    constexpr std::array<std::pair<std::string_view, Key>, 6> kKeys = {{{"begin", Key::begin},
                                                                        {"end", Key::end},
                                                                        {"unknown", Key::unknown},
                                                                        {"remove", Key::remove},
                                                                        {"never", Key::never},
                                                                        {"forget", Key::forget}}};
    for (const auto& [name, key] : kKeys)
        if (name == word) return key;
    return std::nullopt;
}

std::vector<Interval> joined(const std::vector<Interval>& intervals) {
    Intervals result;
    for (const Interval& one : intervals) {
        if (!result.empty() && result.back().end == one.start && result.back().label == one.label)
            result.back().end = one.end;
        else
            result.push_back(one);
    }
    return result;
}

Marks after_key(const Marks& before, Key key, std::uint64_t step, std::uint64_t steps) {
    if (key == Key::forget) return std::nullopt;
    if (key == Key::never) return Intervals();
    Intervals intervals = before.value_or(Intervals());
    if (key == Key::end) {
        end_at(intervals, step);
        return joined(intervals);
    }
    intervals = joined(intervals);
    if (key == Key::begin) {
        begin_at(intervals, step, steps);
        return intervals;
    }
    const auto found = at_or_after(intervals, step);
    if (found == intervals.end() || found->start > step) return before;
    if (key == Key::unknown)
        found->label = found->label == Label::yes ? Label::unknown : Label::yes;
    else
        intervals.erase(found);
    return intervals;
}

}  // namespace etlc::label
