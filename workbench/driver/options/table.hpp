// What the parts of the table of options share: groups of commands, and values.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "driver/options/call.hpp"
#include "driver/options/mistakes.hpp"

namespace etlc::driver {

// The rows of the table of options: the name of an option, its values, and the member that it sets.
// The parser, --help, the manual page, the completions and docs/command_line.md read them.
// Keeps true: a value is taken exactly or refused, never rounded or wrapped; an error says what was
// found and what was expected.

/// A set of commands.
class Commands {
public:
    constexpr Commands(Command command) : bits_(1U << static_cast<unsigned>(command)) {}
    constexpr bool has(Command command) const { return (bits_ & Commands(command).bits_) != 0; }
    friend constexpr Commands operator|(Commands a, Commands b) {
        a.bits_ |= b.bits_;
        return a;
    }

private:
    unsigned bits_;
};

/// The values of an option, and what it does with them.
struct Takes {
    using Words = std::vector<std::string>;

    std::string value;          ///< "FILE"; empty: none, or one of `choices`
    Words choices;              ///< its possible values
    std::string usual;          ///< default value, for --help
    bool is_flag = false;       ///< an optional value follows '='
    bool repeats = false;       ///< takes several values
    bool once_a_name = false;   ///< may be repeated, with one value each time
    bool may_be_empty = false;  ///< may stand without a value
    std::function<std::string(const std::string&)> check;  ///< returns the error of a value, or ""
    /// Sets the member; returns the error of the values together, or "".
    std::function<std::string(Call&, const Words&)> set;
};

struct Option {
    Commands commands;
    std::string
        names;  ///< "-o,--output"; "spec": a positional; "--x{word}": the value of --x alone
    Takes takes;
    std::string help;
    enum class Need : std::uint8_t { none, required } need = Need::none;
    std::string excludes{};  ///< the name of another option
    std::string needs{};
};

/// Returns the options of all commands, in the order of --help.
const std::vector<Option>& options();

/// Returns the place that an option sets: in(&Call::run, &Call::Run::html).
template <class... Members>
auto in(Members... members) {
    return [=](Call & call) -> auto& {
        return (call.*....*members);
    };
}

template <class At>
Takes flag(At at) {
    Takes takes;
    takes.is_flag = true;
    takes.set = [at](Call& call, const Takes::Words&) {
        at(call) = true;
        return std::string();
    };
    return takes;
}

/// A text. `usual`: the default.
template <class At>
Takes text(std::string value, At at, std::string usual = "") {
    Takes takes;
    takes.value = std::move(value);
    takes.usual = std::move(usual);
    takes.set = [at](Call& call, const Takes::Words& words) {
        at(call) = words.front();
        return std::string();
    };
    return takes;
}

template <class At>
Takes file(At at, std::string usual = "") {
    return text("FILE", at, std::move(usual));
}

/// A text that is the only one in a list.
template <class At>
Takes only(std::string value, At at) {
    Takes takes;
    takes.value = std::move(value);
    takes.set = [at](Call& call, const Takes::Words& words) {
        at(call) = words;
        return std::string();
    };
    return takes;
}

inline Takes several(Takes takes) {
    takes.repeats = true;
    return takes;
}

template <class At>
Takes texts(std::string value, At at) {
    return several(only(std::move(value), at));
}

/// One of these words, stored as text.
template <class At>
Takes one_of(Takes::Words choices, At at, std::string usual = "") {
    Takes takes = text("", at, std::move(usual));
    takes.check = [choices](const std::string& found) { return mistake_in_word(found, choices); };
    takes.choices = std::move(choices);
    return takes;
}

/// One of these words, each of which stands for a value; the first is the default.
template <class Value, class At>
Takes choice(std::vector<std::pair<std::string, Value>> meanings, At at) {
    Takes takes;
    for (const auto& [word, value] : meanings) takes.choices.push_back(word);
    takes.usual = takes.choices.front();
    takes.check = [choices = takes.choices](const std::string& found) {
        return mistake_in_word(found, choices);
    };
    takes.set = [at, meanings = std::move(meanings)](Call& call, const Takes::Words& words) {
        for (const auto& [word, value] : meanings)
            if (word == words.front()) at(call) = value;
        return std::string();
    };
    return takes;
}

/// A whole number in [least, most].
template <class Number, class At>
Takes number(At at, std::uint64_t least = 0,
             std::uint64_t most = std::numeric_limits<Number>::max(), std::string usual = "",
             std::string value = "N") {
    Takes takes;
    takes.value = std::move(value);
    takes.usual = std::move(usual);
    takes.check = [=](const std::string& found) { return mistake_in_number(found, least, most); };
    takes.set = [at](Call& call, const Takes::Words& words) {
        at(call) = static_cast<Number>(std::stoull(words.front()));
        return std::string();
    };
    return takes;
}

/// A value with its own syntax, which `set` parses.
inline Takes form(std::string value, decltype(Takes::set) set) {
    Takes takes;
    takes.value = std::move(value);
    takes.set = std::move(set);
    return takes;
}

inline constexpr Commands kExecute = Commands(Command::run) | Command::explain;
inline constexpr Commands kEvaluate = Commands(Command::evaluate) | Command::crossvalidate;
/// The commands that generate a class.
inline constexpr Commands kClass = Commands(Command::compile) | Command::prove | Command::dossier;
/// The commands that plan monitors.
inline constexpr Commands kPlan = kExecute | kEvaluate | kClass | Command::incident |
                                  Command::report | Command::watch | Command::annotate;
inline constexpr Commands kLearn = Commands(Command::fit) | Command::calibrate;
inline constexpr Commands kReadEpisodes = kLearn | kEvaluate | Command::report;
inline constexpr Commands kFindEpisodes = kReadEpisodes | Command::label;
inline constexpr Commands kReadRecordings =
    kFindEpisodes | kExecute | Command::embed | Command::watch | Command::annotate;
inline constexpr Commands kReadSpec = kPlan | kLearn | Command::embed | Command::label;

inline constexpr auto kRequired = Option::Need::required;

inline Takes checked(Takes takes, std::string (*check)(const std::string&)) {
    takes.check = check;
    return takes;
}

inline Takes retargetable() {
    return flag(in(&Call::check, &check::Options::retargetable));
}

inline Takes lets() {
    return flag(in(&Call::check, &check::Options::lets));
}

}  // namespace etlc::driver
