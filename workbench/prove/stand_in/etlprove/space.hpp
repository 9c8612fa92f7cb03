// The diagrams of the program that steps a class for `etlc prove`, the ways that a step can take,
// and the ends of the program. Takes: conditions on samples, on which the class branches. Gives:
// every way through a step, one after the other. Keeps true: the conditions of all ways exclude
// each other and cover everything, since a step that has had the same answers asks the same
// question.
#pragma once

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#ifdef __linux__
#include <signal.h>
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "etlprove/diagrams.hpp"

#ifdef ETLPROVE_COUNTS
extern "C" void __gcov_dump(void);
#endif

namespace etlprove {

[[noreturn]] inline void stop(int status) {
    fflush(stdout);
#ifdef ETLPROVE_COUNTS
    __gcov_dump();
#endif
    _Exit(status);
}

/// Ends the program when etlc ends, even if that is killed.
inline void end_with_etlc() {
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
}

inline Diagrams& diagrams() {
    static Diagrams kept(kMostNodes, [] { stop(kExhausted); });
    return kept;
}

/// Whether values are truth values; else they are robustness.
inline bool& are_truths() {
    static bool kept = false;
    return kept;
}

/// Whether the class measures samples that are there, whose values are not proved.
inline bool& is_measuring() {
    static bool kept = false;
    return kept;
}

/// A diagram in the state of a class is marked, so that it is told from other words.
constexpr uint32_t kMark = 0xa0000000u;
constexpr uint32_t kMarkBits = 0xf0000000u;
constexpr bool is_marked(uint32_t bits) {
    return (bits & kMarkBits) == kMark;
}
constexpr uint32_t marked(Diagram diagram) {
    return kMark | diagram;
}
constexpr uint32_t kMostUnwritten = 1u << 16;
/// Returns the value of a word that earlier steps left, which may be anything.
inline uint32_t left_over(size_t word) {
    if (word >= kFirstSample - kFirstLeft - kMostUnwritten) stop(kExhausted);
    return marked(diagrams().variable(kFirstLeft + 1 + static_cast<Place>(word)));
}

class Ways {
public:
    using Finals = std::vector<std::pair<Diagram, bool>>;

    /// Calls `step` for each way through it, or for one.
    template <class Step>
    void each(const Step& step, bool only_one = false) {
        decisions_.clear();
        do {
            asked_ = 0;
            condition_ = kAlways;
            unwritten_ = 0;
            finals_.clear();
            if (++count_ > most_) stop(kTooMany);
            is_stepping_ = true;
            step();
            is_stepping_ = false;
        } while (!only_one && next());
    }
    /// All that were taken so far.
    uint64_t count() const { return count_; }

    bool decide(Diagram on) {
        if (on <= kAlways) return on == kAlways;
        if (!is_stepping_) stop(kBranches);
        if (is_free(on)) return decide_final(on);
        const Diagram not_on = diagrams().complement(on);
        if (is_free(not_on)) return !decide_final(not_on);
        const Diagram yes = diagrams().both(condition_, on);
        if (yes == kNever) return false;
        if (yes == condition_) return true;
        const bool taken = take();
        condition_ = taken ? yes : diagrams().both(condition_, not_on);
        return taken;
    }

    /// Sets conditions that may be true or false whatever else is: that a verdict is final.
    void set_free(std::vector<Diagram> conditions) { free_ = std::move(conditions); }
    /// Those that were asked on this way.
    const Finals& finals() const { return finals_; }
    /// When the step takes the way that it took, besides those.
    Diagram condition() const { return condition_; }
    void set_most(uint64_t most) { most_ = most; }
    /// Returns a value that is read before it was written. A truth is another one each time.
    Diagram unwritten() {
        if (!are_truths()) return diagrams().variable(kUnwritten);
        if (++unwritten_ >= kMostUnwritten) stop(kExhausted);
        return diagrams().variable(kFirstSample - unwritten_);
    }

private:
    bool is_free(Diagram condition) const {
        return std::find(free_.begin(), free_.end(), condition) != free_.end();
    }
    bool decide_final(Diagram on) {
        for (const auto& [asked, answer] : finals_)
            if (asked == on) return answer;
        finals_.push_back({on, take()});
        return finals_.back().second;
    }
    bool take() {
        if (asked_ == decisions_.size()) decisions_.push_back(false);
        return decisions_[asked_++];
    }
    bool next() {
        while (!decisions_.empty() && decisions_.back()) decisions_.pop_back();
        if (decisions_.empty()) return false;
        decisions_.back() = true;
        return true;
    }

    std::vector<bool> decisions_;  ///< of this way
    size_t asked_ = 0;
    uint32_t unwritten_ = 0;
    Diagram condition_ = kAlways;
    std::vector<Diagram> free_;
    Finals finals_;
    bool is_stepping_ = false;
    uint64_t count_ = 0, most_ = 4000000;
};

inline Ways& ways() {
    static Ways kept;
    return kept;
}

inline Diagram diagram_of(uint32_t bits) {
    return is_marked(bits) ? bits & ~kMarkBits : ways().unwritten();
}

/// A truth as a function of the samples, on which the class may branch.
class Bit {
public:
    Bit() noexcept = default;
    constexpr Bit(bool is) noexcept : bits_(marked(is ? kAlways : kNever)) {}
    static Bit of(Diagram diagram) noexcept {
        Bit bit;
        bit.bits_ = marked(diagram);
        return bit;
    }
    Diagram diagram() const noexcept { return diagram_of(bits_); }
    explicit operator bool() const noexcept { return ways().decide(diagram()); }

    friend Bit operator!(Bit a) noexcept { return of(diagrams().complement(a.diagram())); }
    friend Bit operator&&(Bit a, Bit b) noexcept {
        return of(diagrams().both(a.diagram(), b.diagram()));
    }
    friend Bit operator||(Bit a, Bit b) noexcept {
        return of(diagrams().either(a.diagram(), b.diagram()));
    }
    friend Bit operator!=(Bit a, Bit b) noexcept {
        return of(diagrams().differ(a.diagram(), b.diagram()));
    }
    friend Bit min_of(Bit a, Bit b) noexcept { return a && b; }
    friend Bit max_of(Bit a, Bit b) noexcept { return a || b; }
    friend Bit operator&&(Bit a, bool b) noexcept { return a && Bit(b); }
    friend Bit operator&&(bool a, Bit b) noexcept { return Bit(a) && b; }
    friend Bit operator||(Bit a, bool b) noexcept { return a || Bit(b); }
    friend Bit operator||(bool a, Bit b) noexcept { return Bit(a) || b; }

private:
    uint32_t bits_;
};

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
