// How a step of a class uses its state, for a proof of all lengths. Takes: what the class does.
// Gives: whether a later step, with larger counters and older values, does the same. Keeps true: a
// counter of steps only compares itself with constants, or it says that its value counted.
#pragma once

#include <cstdint>
#include <vector>

#include "etlprove/diagrams.hpp"

namespace etlprove {

/// All uses since the last reset().
class Uses {
public:
    static constexpr uint32_t kAll = 0xffffffffu;

    void reset() {
        counters_.clear();
        counted_ = 0;
        oldest_ = 0;
    }

    /// A counter has advanced.
    void advances(const void* counter) { counters_.push_back(counter); }
    /// A counter that reaches a constant would have had another effect.
    void counts_to(uint64_t constant) {
        const uint32_t least = constant < kAll ? static_cast<uint32_t>(constant) : kAll;
        if (least > counted_) counted_ = least;
    }
    /// A value is negated. The negation is a function of its samples, not of the value alone.
    void negates(const Diagrams& diagrams, Diagram of) {
        const Place deepest = deepest_in(diagrams, of);
        if (deepest > oldest_) oldest_ = deepest;
    }

    const std::vector<const void*>& counters() const { return counters_; }
    /// The greatest such constant, or kAll where each value may have an effect of its own.
    uint32_t counted() const { return counted_; }
    /// The place of the oldest sample in what was negated.
    Place oldest() const { return oldest_; }

private:
    Place deepest_in(const Diagrams& diagrams, Diagram of) {
        if (of <= kAlways) return 0;
        if (deepest_.size() <= of) deepest_.resize(diagrams.size(), 0);
        if (deepest_[of] != 0) return deepest_[of];
        const Diagrams::Node node = diagrams[of];
        Place deepest = node.place;
        for (const Diagram part : {node.without, node.with}) {
            const Place below = deepest_in(diagrams, part);
            if (below > deepest) deepest = below;
        }
        deepest_[of] = deepest;
        return deepest;
    }

    std::vector<const void*> counters_;
    uint32_t counted_ = 0;
    Place oldest_ = 0;
    std::vector<Place> deepest_;  ///< [diagram] 0: not yet found
};

inline Uses& uses() {
    static Uses kept;
    return kept;
}

/// A number of steps, in place of a uint32_t member that grows at every step and saturates.
class Counter {
public:
    constexpr Counter() noexcept = default;
    constexpr Counter& operator=(uint32_t value) noexcept {
        value_ = value;
        return *this;
    }
    void advance() noexcept {
        if (value_ != 0xffffffffu) ++value_;
        uses().advances(this);
    }

    template <class Number>
    bool operator>=(Number least) const noexcept {
        return up_to(static_cast<uint32_t>(least)) >= static_cast<uint32_t>(least);
    }
    template <class Number>
    bool operator<(Number least) const noexcept {
        return !(*this >= least);
    }
    template <class Number>
    bool operator>(Number most) const noexcept {
        return !(*this <= most);
    }
    template <class Number>
    bool operator<=(Number most) const noexcept {
        return up_to(uint64_t{static_cast<uint32_t>(most)} + 1) <= static_cast<uint32_t>(most);
    }
    template <class Number>
    bool operator==(Number other) const noexcept {
        return up_to(uint64_t{static_cast<uint32_t>(other)} + 1) == static_cast<uint32_t>(other);
    }
    template <class Number>
    bool operator!=(Number other) const noexcept {
        return !(*this == other);
    }
    /// Returns the lesser of the value and a constant, for what treats all values from there alike.
    uint64_t up_to(uint64_t constant) const noexcept {
        if (value_ >= constant) return constant;
        uses().counts_to(constant);
        return value_;
    }
    operator uint32_t() const noexcept {
        uses().counts_to(Uses::kAll);
        return value_;
    }

private:
    uint32_t value_ = 0;
};
static_assert(sizeof(Counter) == sizeof(uint32_t), "as large as what it replaces");

}  // namespace etlprove
