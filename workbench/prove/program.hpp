// The program that steps a class on symbols: its sources, its compilation, and what it says.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "data/files/child.hpp"
#include "diag/diag.hpp"
#include "emit/standalone.hpp"
#include "plan/plan.hpp"
#include "prove/prove.hpp"
#include "prove/symbols/definition.hpp"
#include "prove/symbols/symbol.hpp"

namespace etlc::prove {

using emit::RuntimeFile;

/// A class.
struct Subject {
    std::string header;      ///< text of the generated header
    std::string name_space;  ///< of its class
};

/// The compiled program, in a temporary folder of its own.
class Program {
public:
    /// Writes and compiles it.
    static diag::Result<Program> make(const plan::Plan& plan, const Subject& subject,
                                      const std::vector<Atom>& atoms);
    /// `headers`: the first that compiles is taken; `main`: the text of the program; `folders`:
    /// where the compiler looks for headers; `files`: more of them, in the folder of those that
    /// stand in.
    static diag::Result<Program> make(const std::vector<std::string>& headers,
                                      const std::string& main, const std::string& folders,
                                      const std::vector<RuntimeFile>& files);
    Program(Program&& other) noexcept;
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program();

    std::unique_ptr<data::Child> start(const std::set<float>& numbers, std::uint32_t steps) const;
    /// Returns the first line of what the compiler says of its version.
    const std::string& compiler() const { return compiler_; }

private:
    explicit Program(std::string folder) : folder_(std::move(folder)) {}

    std::string folder_;
    std::string compiler_;
};

/// How a program ended before its last entry.
struct Ended {
    enum class Why : std::uint8_t {
        branches,
        exhausted,
        too_many,
        leftovers,
        failed
    } why = Why::failed;
    std::string how;  ///< "was stopped by signal 11 (Segmentation fault)"
};

/// Returns why there is no proof.
std::string why(const Ended& ended);
/// Returns "; it is right for all inputs of up to 4 steps", or nothing.
std::string how_far(std::uint32_t steps);

/// A window over pairs: whether it is one window of the lows and one of the highs.
struct Window {
    std::uint32_t length = 0;
    bool is_two_windows = false;
    bool is_too_long = false;  ///< for a proof of that
};

/// Restarts of several monitors: whether none disturbs another, and for how many steps that is
/// known.
struct Together {
    std::uint32_t steps = 0;
    bool is_proved = false;
};

/// The conditions of a verdict of truth values, of a monitor that began at a step.
struct Status {
    std::uint32_t begun = 0;
    Diagram condition = 0;  ///< that it began there; the others are within this one
    Diagram satisfied = 0;
    Diagram violated = 0;
    Diagram decided = 0;
    Diagram final = 0;
};

/// The state of a class after a step, and how the step used the one before.
struct State {
    enum class Kind : std::uint8_t { control, diagram, counter };
    struct Word {
        Kind kind = Kind::control;
        std::uint32_t value = 0;  ///< of this proof, if it is a diagram
    };
    std::vector<Word> words;  ///< none where the class has other members than words
    /// A counter that reaches this would have another effect; 0 where none would.
    std::uint32_t counted = 0;
    static constexpr std::uint32_t kAll = 0xffffffffU;  ///< where each value may have one
    Place oldest_negated = 0;                           ///< of the samples in what was negated
};

/// Reads what the program says, into the diagrams of this proof.
class Answers {
public:
    Answers(data::Child& child, Space& space) : child_(child), space_(space) {}

    /// Return the next entry, which must be of this kind. Throw Ended and NewNumber.
    Numbers verdict();
    State state();
    /// Whether all later restarts were alike.
    bool forgotten();
    Together together();
    /// The next of the conditions of a step, if there is one more.
    std::optional<Status> status();
    /// The next window of the class, if there is one more.
    std::optional<Window> window();

private:
    std::uint32_t word();
    std::uint32_t next();  ///< the kind of the next entry besides diagrams
    Diagram known(std::uint32_t theirs) const;
    [[noreturn]] void end();

    data::Child& child_;
    Space& space_;
    std::unordered_map<std::uint32_t, Diagram> known_{{0, 0}, {1, 1}};
};

}  // namespace etlc::prove
