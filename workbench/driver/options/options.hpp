// Options of the command line whose value is one of some words, or a number.
// Gives: options that name what was found and what was expected, with the word that was perhaps
// meant. Keeps true: a value is taken as it is written or refused, never rounded or wrapped.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "plan/recorder.hpp"

namespace etlc::driver {

/// A word that an option takes, and what it means.
template <class Value>
using Choice = std::pair<std::string, Value>;

/// "found 'bool', expected robustness or boolean"; empty where the word is one of them.
std::string mistake_in_word(const std::string& found, const std::vector<std::string>& expected);

/// The same of a whole number in [least, most], in decimal digits.
std::string mistake_in_number(const std::string& found, std::uint64_t least, std::uint64_t most);

/// Of a reason that is written into files: it has words and stands on one line.
std::string mistake_in_reason(const std::string& found);

/// Of BEFORE,AFTER,INCIDENTS: two numbers of steps or durations, and a number from 1 on.
std::string mistake_in_recorder(const std::string& found);
/// The same without a mistake.
plan::RecorderRequest recorder(const std::string& text);

/// Refuses other words.
CLI::Validator one_of(std::vector<std::string> words);

/// An option that takes one of these words, the first where it is absent.
template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value,
                        std::vector<Choice<Value>> choices, const std::string& help) {
    std::vector<std::string> words;
    for (const Choice<Value>& choice : choices) words.push_back(choice.first);
    const std::string usual = words.front();
    return app
        .add_option_function<std::string>(
            name,
            [&value, choices = std::move(choices)](const std::string& word) {
                for (const Choice<Value>& choice : choices)
                    if (choice.first == word) value = choice.second;
            },
            help)
        ->type_name("")
        ->check(one_of(std::move(words)))
        ->default_str(usual);
}

/// An option that takes a whole number in [least, most].
template <class Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, Number& value,
                        const std::string& help, std::uint64_t least = 0,
                        std::uint64_t most = std::numeric_limits<Number>::max()) {
    return app
        .add_option_function<std::string>(
            name,
            [&value](const std::string& digits) {
                value = static_cast<Number>(std::stoull(digits));
            },
            help)
        ->type_name("N")
        ->check(CLI::Validator(
            [=](const std::string& found) { return mistake_in_number(found, least, most); }, ""));
}

/// The same of a limit, whose default is what it is before.
inline CLI::Option* add_limit(CLI::App& app, const std::string& name, std::uint64_t& limit,
                              const std::string& help) {
    return add_number(app, name, limit, help)->default_str(std::to_string(limit));
}

}  // namespace etlc::driver
