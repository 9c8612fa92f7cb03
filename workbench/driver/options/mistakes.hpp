// Parses the values of options that have their own syntax, and checks values and calls.
// Every function returns an error that says what was found and what was expected, or "".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "driver/options/call.hpp"

namespace etlc::driver {

/// --set NAME=VALUE
std::string read_settings(Call& call, const std::vector<std::string>& words);
/// --map NAME=OTHER
std::string read_names(Call& call, const std::vector<std::string>& words);
/// --camera NAME for all inputs, or INPUT=NAME
std::string read_cameras(Call& call, const std::vector<std::string>& words);
/// --shard 3/64, or -/64 in a rank of an MPI job
std::string read_shard(Call& call, const std::vector<std::string>& words);
/// --split FROM:TO[:order]
std::string read_split(Call& call, const std::vector<std::string>& words);
/// --recorder BEFORE,AFTER,INCIDENTS: two numbers of steps or durations, and a number from 1 on
std::string read_recorder(Call& call, const std::vector<std::string>& words);
/// --variants cut,reversed
std::string read_variants(Call& call, const std::vector<std::string>& words);
/// --at SECONDS, from 0
std::string read_seconds(Call& call, const std::vector<std::string>& words);
/// --suggest [PREDICATE...]
std::string read_suggest(Call& call, const std::vector<std::string>& words);

/// "found 'bool', expected robustness or boolean"
std::string mistake_in_word(const std::string& found, const std::vector<std::string>& expected);
/// Expected: a whole number in [least, most], in decimal digits.
std::string mistake_in_number(const std::string& found, std::uint64_t least, std::uint64_t most);
/// Expected: a reason in words on one line, since it is written into files.
std::string mistake_in_reason(const std::string& found);
/// Expected: a or a::b without reserved names.
std::string mistake_in_namespace(const std::string& name);

/// Says which word of a call is empty. An option would take the next word for its value.
std::string mistake_in_words(int argc, char** argv);

/// Checks whether the first word is meant as a command that does not exist.
std::string mistake_in_command(int argc, char** argv);

/// Checks the options of a call together.
std::string mistake_in(const Call& call);

}  // namespace etlc::driver
