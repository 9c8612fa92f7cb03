// The numbers of a proof: robustness as a function of all samples.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "prove/stand_in/etlprove/diagrams.hpp"

namespace etlc::prove {

using etlprove::Diagram;
using etlprove::Place;

/// Thrown where the diagrams do not fit into memory.
struct Exhausted {};

/// Thrown where a number is not among those of the proof.
struct NewNumber {
    float number;
};

/// The diagrams of one proof, and its numbers.
struct Space {
    explicit Space(const std::set<float>& known)
        : numbers(diagrams, std::vector<float>(known.begin(), known.end())) {}

    Diagram at_least(float x) const {
        const Diagram found = numbers.at_least(x);
        if (found == etlprove::Numbers::kNoNumber) throw NewNumber{x};
        return found;
    }

    etlprove::Diagrams diagrams{kMostNodes, [] { throw Exhausted(); }};
    etlprove::Numbers numbers;

    static constexpr std::uint32_t kMostNodes = 40U << 20U;
};

/// A function of the samples, of the proof that runs in this thread.
class Symbol {
public:
    Symbol() = default;
    Symbol(double number)  // NOLINT(google-explicit-constructor)
        : of_(space().at_least(static_cast<float>(number))) {}
    static Symbol of(Diagram diagram) {
        Symbol symbol;
        symbol.of_ = diagram;
        return symbol;
    }
    static Symbol variable(Place place) { return of(space().diagrams.variable(place)); }
    Diagram diagram() const { return of_; }

    Symbol operator-() const { return of(space().diagrams.negation(of_)); }
    Symbol operator!() const { return of(space().diagrams.complement(of_)); }
    friend Symbol min(Symbol a, Symbol b) { return of(space().diagrams.both(a.of_, b.of_)); }
    friend Symbol max(Symbol a, Symbol b) { return of(space().diagrams.either(a.of_, b.of_)); }

    /// Makes a space that of this thread, while it exists.
    class Scope {
    public:
        explicit Scope(Space& space) : before_(current()) { current() = &space; }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;
        ~Scope() { current() = before_; }

    private:
        Space* before_;
    };

private:
    static Space*& current() {
        static thread_local Space* space = nullptr;
        return space;
    }
    static Space& space() { return *current(); }

    Diagram of_ = etlprove::kNever;
};

}  // namespace etlc::prove
