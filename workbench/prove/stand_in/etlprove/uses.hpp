// How a step of a class uses its state. Takes: what the class does with members that are
// uint32_t, each of which is a Word here. Gives: whether a later step, with greater counts and
// older values, does the same. Keeps true: a word compares itself with constants, or all of its
// value counts.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "etlprove/space.hpp"

namespace etlprove {

/// Uses of the words of a class by calls.
struct Used {
    static constexpr uint32_t kAll = 0xffffffffu;

    std::map<size_t, uint32_t> counts;  ///< by the word: the greatest constant that would count
    std::set<size_t> advanced;
    Place oldest = 0;  ///< sample in what was negated

    /// The greatest constant that the word, if it reached it, would have another effect by; kAll
    /// where each value may have an effect of its own.
    uint32_t counted(size_t word) const {
        const auto found = counts.find(word);
        return found == counts.end() ? 0 : found->second;
    }
    void count(size_t word, uint32_t constant) {
        uint32_t& most = counts[word];
        if (constant > most) most = constant;
    }
};

/// All uses of one object since the last reset().
class Uses {
public:
    void set_object(const void* begin, size_t bytes) {
        begin_ = static_cast<const unsigned char*>(begin);
        bytes_ = bytes;
    }
    void reset() { used_ = Used(); }
    const Used& so_far() const { return used_; }

    void advances(const void* word) {
        if (is_within(word)) used_.advanced.insert(at(word));
    }
    void counts_to(const void* word, uint64_t constant) {
        if (is_within(word))
            used_.count(at(word),
                        constant < Used::kAll ? static_cast<uint32_t>(constant) : Used::kAll);
    }
    /// A value is negated. The negation is a function of its samples, not of the value alone.
    void negates(Diagram of) {
        const Place deepest = deepest_in(of);
        if (deepest > used_.oldest) used_.oldest = deepest;
    }

private:
    bool is_within(const void* word) const {
        const auto* const byte = static_cast<const unsigned char*>(word);
        return byte >= begin_ && byte < begin_ + bytes_;
    }
    size_t at(const void* word) const {
        return static_cast<size_t>(static_cast<const unsigned char*>(word) - begin_) /
               sizeof(uint32_t);
    }
    Place deepest_in(Diagram of) {
        if (of <= kAlways) return 0;
        if (deepest_.size() <= of) deepest_.resize(diagrams().size(), 0);
        if (deepest_[of] != 0) return deepest_[of];
        const Diagrams::Node node = diagrams()[of];
        Place deepest = node.place;
        for (const Diagram part : {node.without, node.with}) {
            const Place below = deepest_in(part);
            if (below > deepest) deepest = below;
        }
        deepest_[of] = deepest;
        return deepest;
    }

    const unsigned char* begin_ = nullptr;
    size_t bytes_ = 0;
    Used used_;
    std::vector<Place> deepest_;  ///< [diagram] 0: not yet found
};

inline Uses& uses() {
    static Uses kept;
    return kept;
}

/// A uint32_t of the class. That it saturates is in the text of the class: a comparison with the
/// greatest number is no use of the value, as the driver sees by setting it to that.
class Word {
public:
    Word() noexcept = default;
    constexpr Word(uint32_t value) noexcept : value_(value) {}
    Word(const Word& other) noexcept : value_(other.all()) {}
    Word& operator=(const Word& other) noexcept {
        value_ = other.all();
        return *this;
    }
    constexpr Word& operator=(uint32_t value) noexcept {
        value_ = value;
        return *this;
    }
    Word& operator++() noexcept {
        ++value_;
        uses().advances(this);
        return *this;
    }

    operator uint32_t() const noexcept { return all(); }
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
        const uint32_t number = static_cast<uint32_t>(other);
        if (number == Used::kAll) return value_ == number;
        return up_to(uint64_t{number} + 1) == number;
    }
    template <class Number>
    bool operator!=(Number other) const noexcept {
        return !(*this == other);
    }
    /// Returns the lesser of the value and a constant, for what treats all values from there alike.
    uint64_t up_to(uint64_t constant) const noexcept {
        uses().counts_to(this, value_ < constant ? constant : 1);
        return value_ < constant ? value_ : constant;
    }

private:
    uint32_t all() const noexcept {
        uses().counts_to(this, Used::kAll);
        return value_;
    }

    uint32_t value_;
};
static_assert(sizeof(Word) == sizeof(uint32_t), "as large as what it replaces");

}  // namespace etlprove
