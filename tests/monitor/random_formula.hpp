// Random formulas as text, with symbols or words, and with necessary and some unnecessary brackets.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "random.hpp"

namespace etlc::tests {

struct FormulaShape {
    int depth = 2;
    int window = 4;
    bool nested = true;             ///< temporal operators below temporal operators
    bool bounded = true;            ///< future operators with an upper bound
    bool unbounded = true;          ///< unbounded future operators
    bool past_over_future = false;  ///< otherwise past operators see only the past and the present
    double future = 0.5;            ///< fraction of future operators where both kinds are allowed
    int phases = 0;                 ///< if not 0: chains of at most so many phases,
    bool timed = false;             ///< or sequences of them, with bounded intervals
};

class RandomFormula {
public:
    RandomFormula(Random& random, std::vector<std::string> atoms,
                  std::function<std::string()> comparison, FormulaShape shape,
                  std::string let_name = "part")
        : random_(random),
          atoms_(std::move(atoms)),
          comparison_(std::move(comparison)),
          shape_(shape),
          let_name_(std::move(let_name)) {}

    std::string make() {
        if (shape_.timed)
            return sequence(random_.between(1, shape_.phases), random_.chance(0.5)).text;
        if (shape_.phases > 0)
            return chain(random_.between(1, shape_.phases), random_.chance(0.5)).text;
        return grow(shape_.depth, {true, true}).text;
    }
    /// The lets that formulas made since the last call refer to.
    std::string take_lets() { return std::exchange(lets_, {}); }

private:
    /// Binding strength, loosest first.
    enum Level { iff, implies, disjunction, conjunction, until, prefix, atom };
    struct Piece {
        std::string text;
        Level level;
    };
    struct Allowed {
        bool future;
        bool past;
    };

    Random& random_;
    std::vector<std::string> atoms_;
    std::function<std::string()> comparison_;
    FormulaShape shape_;
    std::string let_name_;
    std::string lets_;
    int let_count_ = 0;

    Piece grow(int depth, Allowed allowed);
    Piece leaf();
    Piece connective(int depth, Allowed allowed);
    Piece future(int depth, Allowed allowed);
    Piece past(int depth, Allowed allowed);
    Piece response_in_two(int depth, Allowed allowed);
    Piece chain(int phases, bool max);
    Piece early(int phases, bool max);
    Piece late(int phases, bool max);
    Piece sequence(int phases, bool max);
    Piece count(const Piece& operand);
    Piece named(Piece piece);
    Piece unary(const std::string& word, const std::string& interval, const Piece& operand);
    Piece binary(const Piece& left, const std::string& word, const std::string& interval,
                 const Piece& right, Level level);
    /// Adds brackets unless it binds tighter than `outer`.
    std::string inside(const Piece& piece, Level outer);
    std::string bounded_interval();
    std::string future_interval();
    std::string past_interval();
};

}  // namespace etlc::tests
