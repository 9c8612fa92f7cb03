// Binary decision diagrams of monotone functions, for etlc and for the programs that it compiles.
// Takes: variables, by their place in the order. Gives: min, max and negation of robustness as
// functions of "this is at least the threshold". Keeps true: equal functions are the same number,
// since every node exists once (Bryant 1986). Nothing is ever freed; the numbers of nodes and
// of operations are limited.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace etlprove {

/// A function: the number of its topmost node.
using Diagram = std::uint32_t;
constexpr Diagram kNever = 0;
constexpr Diagram kAlways = 1;
constexpr std::uint32_t kMostNodes = 40u << 20;  ///< of a proof, and of its program

/// The variables, in their order. Place 1 is what was read before it was written; then numbers, the
/// least first; then what earlier steps left, by its word in a class; then samples, the last first,
/// four a sample: its lower end, the negated lower end, its upper end and the negated upper end. So
/// the variables of a sample and of its negation are neighbours.
using Place = std::uint32_t;
constexpr Place kUnwritten = 1;
constexpr Place kFirstNumber = 2;
constexpr Place kFirstLeft = 1u << 16;
constexpr Place kFirstSample = 1u << 20;
constexpr Place kNoPlace = 0xffffffffu;
constexpr Place kLow = 0, kNegatedLow = 1, kHigh = 2, kNegatedHigh = 3;
constexpr Place kPlacesPerSample = 4;

/// A step of so many. The later samples come first, so that a step changes only the top of what it
/// adds to.
struct Step {
    std::uint32_t step, of;
};
/// Returns the variable of an end of a sample.
constexpr Place place_of(Step at, std::size_t atom, std::size_t atoms, Place end) {
    return kFirstSample +
           static_cast<Place>((at.of - 1 - at.step) * atoms + atom) * kPlacesPerSample + end;
}

class Diagrams {
public:
    struct Node {
        Place place;
        Diagram without;  ///< the function where the variable is false
        Diagram with;     ///< and where it is true
    };

    /// `exhausted` is called where there would be more than `most` nodes; it must not return.
    Diagrams(std::uint32_t most, void (*exhausted)()) : most_(most), exhausted_(exhausted) {
        nodes_.push_back({kNoPlace, kNever, kNever});
        nodes_.push_back({kNoPlace, kAlways, kAlways});
        grow();
    }

    Diagram variable(Place place) { return node(place, kNever, kAlways); }

    /// Min and max: both, or one of them, is at least the threshold.
    Diagram both(Diagram a, Diagram b) {
        if (a == b || b == kAlways) return a;
        if (a == kAlways) return b;
        if (a == kNever || b == kNever) return kNever;
        return combine(Operation::both, a < b ? a : b, a < b ? b : a);
    }
    Diagram either(Diagram a, Diagram b) {
        if (a == b || b == kNever) return a;
        if (a == kNever) return b;
        if (a == kAlways || b == kAlways) return kAlways;
        return combine(Operation::either, a < b ? a : b, a < b ? b : a);
    }
    /// One of them, but not both.
    Diagram differ(Diagram a, Diagram b) {
        if (a == b) return kNever;
        if (a == kNever) return b;
        if (b == kNever) return a;
        return combine(Operation::differ, a < b ? a : b, a < b ? b : a);
    }
    Diagram complement(Diagram a) { return differ(a, kAlways); }

    /// The robustness, negated: max becomes min, and each variable that of the negation.
    Diagram negation(Diagram a) {
        if (a <= kAlways) return 1 - a;
        const Place place = nodes_[a].place;
        if (place >= kFirstNumber && place < kFirstLeft) return negated_levels(a);
        return remembered(Operation::negation, a, 0, [&] {
            const Node of = nodes_[a];
            const Diagram with = negation(of.without), without = negation(of.with);
            return choose(place < kFirstSample ? place : place ^ 1u, without, with);
        });
    }

    /// The robustness is at least 0: the function where the threshold is that.
    Diagram at_zero(Diagram a) {
        if (a <= kAlways) return a;
        const Place place = nodes_[a].place;
        if (place >= kFirstNumber && place < kFirstLeft)
            return at_zero(place - kFirstNumber < negative_ ? nodes_[a].without : nodes_[a].with);
        return remembered(Operation::zero, a, 0, [&] {
            const Node of = nodes_[a];
            const Diagram without = at_zero(of.without), with = at_zero(of.with);
            return choose(of.place, without, with);
        });
    }

    /// Sets the number of numbers, which contain the negation of each, and of those below 0.
    void set_numbers(std::uint32_t count, std::uint32_t negative) {
        numbers_ = count;
        negative_ = negative;
    }

    /// `with` where the variable is true, else `without`.
    Diagram choose(Place place, Diagram without, Diagram with) {
        if (without == with) return with;
        if (place < place_of(without) && place < place_of(with)) return node(place, without, with);
        const Diagram here = variable(place);
        return either(both(here, with), both(complement(here), without));
    }

    const Node& operator[](Diagram a) const { return nodes_[a]; }
    std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }

private:
    enum class Operation : std::uint32_t { none, both, either, differ, negation, zero };
    struct Result {
        Operation operation = Operation::none;
        Diagram a = 0, b = 0, result = 0;
    };
    static constexpr std::uint32_t kMostResults = 1u << 22;
    /// So many take some minutes.
    static constexpr std::uint64_t kMostOperations = std::uint64_t{1} << 31;

    static std::uint32_t hash(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        std::uint64_t mixed = (std::uint64_t{a} << 32 | b) * 0x9e3779b97f4a7c15u;
        mixed = (mixed ^ mixed >> 29 ^ c) * 0xbf58476d1ce4e5b9u;
        return static_cast<std::uint32_t>(mixed ^ mixed >> 32);
    }

    Place place_of(Diagram a) const { return nodes_[a].place; }

    /// A number is at least the threshold where the threshold is not above it. The threshold is not
    /// above the first number (level 0), only above that, and so on; a negation turns the levels
    /// around.
    Diagram negated_levels(Diagram a) {
        return remembered(Operation::negation, a, 0, [&] {
            std::vector<Diagram> levels;
            Diagram rest = a;
            for (std::uint32_t n = 0; n < numbers_; ++n) {
                const bool asks = nodes_[rest].place == kFirstNumber + n;
                levels.push_back(asks ? nodes_[rest].with : rest);
                if (asks) rest = nodes_[rest].without;
            }
            levels.push_back(rest);
            Diagram result = negation(levels[0]);
            for (std::uint32_t n = 1; n <= numbers_; ++n)
                result = choose(kFirstNumber + numbers_ - n, result, negation(levels[n]));
            return result;
        });
    }

    template <class Find>
    Diagram remembered(Operation operation, Diagram a, Diagram b, const Find& find) {
        const std::uint32_t at = hash(a, b, static_cast<std::uint32_t>(operation)) &
                                 (static_cast<std::uint32_t>(results_.size()) - 1);
        const Result known = results_[at];
        if (known.operation == operation && known.a == a && known.b == b) return known.result;
        if (++operations_ > kMostOperations) exhausted_();
        const Diagram result = find();
        results_[at] = {operation, a, b, result};
        return result;
    }

    Diagram combine(Operation operation, Diagram a, Diagram b) {
        return remembered(operation, a, b, [&] {
            const Node x = nodes_[a], y = nodes_[b];
            const Place place = x.place < y.place ? x.place : y.place;
            const auto apply = [&](Diagram one, Diagram other) {
                return operation == Operation::both     ? both(one, other)
                       : operation == Operation::either ? either(one, other)
                                                        : differ(one, other);
            };
            const Diagram without =
                apply(x.place == place ? x.without : a, y.place == place ? y.without : b);
            const Diagram with =
                apply(x.place == place ? x.with : a, y.place == place ? y.with : b);
            return node(place, without, with);
        });
    }

    /// Returns the one node of this kind.
    Diagram node(Place place, Diagram without, Diagram with) {
        if (without == with) return with;
        const std::uint32_t mask = static_cast<std::uint32_t>(slots_.size()) - 1;
        std::uint32_t at = hash(place, without, with) & mask;
        for (; slots_[at] != 0; at = (at + 1) & mask) {
            const Node& found = nodes_[slots_[at]];
            if (found.place == place && found.without == without && found.with == with)
                return slots_[at];
        }
        if (nodes_.size() >= most_) exhausted_();
        slots_[at] = size();
        nodes_.push_back({place, without, with});
        const Diagram made = slots_[at];
        if (nodes_.size() * 2 > slots_.size()) grow();
        return made;
    }

    /// Doubles the table of nodes, which is at most half full.
    void grow() {
        std::vector<Diagram> slots(slots_.empty() ? 1u << 16 : slots_.size() * 2, 0);
        const std::uint32_t mask = static_cast<std::uint32_t>(slots.size()) - 1;
        for (Diagram n = 2; n < size(); ++n) {
            std::uint32_t at = hash(nodes_[n].place, nodes_[n].without, nodes_[n].with) & mask;
            while (slots[at] != 0) at = (at + 1) & mask;
            slots[at] = n;
        }
        slots_ = std::move(slots);
        if (results_.size() < slots_.size() && results_.size() < kMostResults)
            results_.assign(slots_.size(), {});
    }

    std::uint32_t most_;
    std::uint32_t numbers_ = 0, negative_ = 0;
    std::uint64_t operations_ = 0;  ///< whose result was not remembered
    void (*exhausted_)();
    std::vector<Node> nodes_;
    std::vector<Diagram> slots_;  ///< 0: free
    std::vector<Result> results_;
};

/// The numbers of a proof. A number is at least the threshold if some number that is not greater
/// is; so equal functions of the threshold are equal diagrams, whatever numbers they name.
class Numbers {
public:
    /// `numbers`: in order, finite, with the negation of each.
    Numbers(Diagrams& diagrams, std::vector<float> numbers) : numbers_(std::move(numbers)) {
        std::uint32_t negative = 0;
        while (negative < numbers_.size() && numbers_[negative] < 0) ++negative;
        diagrams.set_numbers(static_cast<std::uint32_t>(numbers_.size()), negative);
        Diagram so_far = kNever;
        for (std::uint32_t n = 0; n < numbers_.size(); ++n) {
            so_far = diagrams.either(so_far, diagrams.variable(kFirstNumber + n));
            at_least_.push_back(so_far);
        }
    }

    /// Returns "x is at least the threshold"; kNoNumber if x is not among the numbers.
    static constexpr Diagram kNoNumber = 0xffffffffu;
    Diagram at_least(float x) const {
        if (x > 3.402823466e38f) return kAlways;
        if (x < -3.402823466e38f) return kNever;
        for (std::size_t n = 0; n < numbers_.size(); ++n)
            if (numbers_[n] == x) return at_least_[n];
        return kNoNumber;
    }
    float operator[](Place place) const { return numbers_[place - kFirstNumber]; }
    const std::vector<float>& all() const { return numbers_; }

private:
    std::vector<float> numbers_;
    std::vector<Diagram> at_least_;
};

/// The truths that an atom may have at a step: any of three truths, one of the two that are known,
/// or one.
enum class Truths : std::uint32_t { any, known, yes, no };

/// When a truth is surely true, and when it is possibly true.
struct Ends {
    Diagram low, high;
};

/// `sample`: the first place of the sample.
inline Ends ends_of(Diagrams& diagrams, Truths truths, Place sample) {
    if (truths == Truths::yes) return {kAlways, kAlways};
    if (truths == Truths::no) return {kNever, kNever};
    const Diagram high = diagrams.variable(sample + kHigh);
    if (truths == Truths::known) return {high, high};
    return {diagrams.both(high, diagrams.variable(sample + kLow)), high};
}

// What the program of a proof says, and how it ends.

/// The words that begin an entry of its output.
enum class Entry : std::uint32_t {
    number = 1,
    node,
    verdict,
    state,
    restarts,
    saturation,
    window,
    end
};

/// The kinds of words of a state.
enum class WordKind : std::uint32_t { control, diagram, counter };

/// Its exit statuses besides 0.
constexpr int kBranches = 10, kExhausted = 11, kNewNumber = 12, kTooMany = 13, kLeftovers = 14,
              kReadsTelemetry = 15, kOtherHalves = 16, kOtherNames = 17, kOtherRestarts = 18,
              kNotReset = 19;

}  // namespace etlprove
