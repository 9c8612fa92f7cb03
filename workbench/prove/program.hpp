// The program that drives a class on symbols: its sources, its compilation, and what it says.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "data/files/child.hpp"
#include "diag/diag.hpp"
#include "emit/standalone.hpp"
#include "plan/plan.hpp"
#include "prove/prove.hpp"
#include "prove/symbols.hpp"

namespace etlc::prove {

using emit::RuntimeFile;

/// The compiled program, in a temporary folder of its own.
class Program {
public:
    /// Writes and compiles it, and asks the compiler for the variables of the class besides its
    /// members: fails where there are some.
    static diag::Result<Program> make(const plan::Plan& plan, const Request& request,
                                      const std::vector<Atom>& atoms,
                                      const std::vector<Truths>& truths);
    Program(Program&& other) noexcept;
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program();

    std::unique_ptr<data::Child> start(const std::set<float>& numbers, std::uint32_t steps) const;
    /// Returns what gcov says of all that has run so far, as JSON.
    std::string coverage() const;
    /// Returns the first line of what the compiler says of its version.
    const std::string& compiler() const { return compiler_; }

private:
    explicit Program(std::string folder) : folder_(std::move(folder)) {}

    std::string folder_;
    std::string compiler_;
};

/// Calls of finish() after each step, in which every sliding monitor reports its last positions.
std::uint32_t finishes_of(const plan::Plan& plan);

/// Returns the parts of an object file that a program can write: "4 bytes in .bss"; "" if it has
/// none, and "no ELF file" for another format.
std::string writable_parts(const std::string& object);

/// How a program ended before its last entry.
struct Ended {
    int status = 0;
    std::string how;  ///< "was stopped by signal 11 (Segmentation fault)"
};

/// Returns why there is no proof.
std::string why(const Ended& ended);

/// A window over pairs: whether it is one window of the lows and one of the highs.
struct Window {
    std::uint32_t length = 0;
    bool is_two_windows = false;
    bool is_too_long = false;  ///< for a proof of that
};

/// A verdict of the class.
struct Reported {
    bool may_be_missing = false;  ///< every sample; else none
    std::uint32_t monitor = 0;
    std::uint32_t step = 0;
    std::uint32_t finishes = 0;        ///< calls of finish() after it
    std::vector<std::uint32_t> begun;  ///< [monitor] the step at which it last began
    Numbers numbers;
    Diagram satisfied = 0;
    Diagram violated = 0;
    Diagram final = 0;
};

/// The state of a class after a step, and how the step used the one before.
struct State {
    struct Word {
        etlprove::WordKind kind = etlprove::WordKind::control;
        std::uint32_t value = 0;    ///< of this proof, if it is a diagram
        std::uint32_t counted = 0;  ///< a counter that reaches this would have another effect
    };
    std::vector<Word> words;   ///< none where the class has other members than words
    Place oldest_negated = 0;  ///< of the samples in what was negated
};

/// Reads what the program says, into the diagrams of this proof. All throw Ended and NewNumber.
class Answers {
public:
    Answers(data::Child& child, Space& space, std::size_t monitors)
        : child_(child), space_(space), monitors_(monitors) {}

    /// Returns the kind of the next entry, which is then read.
    etlprove::Entry next();
    Reported verdict();
    State state();
    Window window();
    std::uint32_t word();

private:
    Diagram known(std::uint32_t theirs) const;
    [[noreturn]] void end();

    data::Child& child_;
    Space& space_;
    std::size_t monitors_;
    std::unordered_map<std::uint32_t, Diagram> known_{{0, 0}, {1, 1}};
};

}  // namespace etlc::prove
