// What is wrong with a value of an option, or with several options together.
// Takes: words of the call. Gives: a sentence that names what was found and what was expected;
// empty where nothing is wrong.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace etlc::driver {

struct Call;

/// "found 'bool', expected robustness or boolean"
std::string mistake_in_word(const std::string& found, const std::vector<std::string>& expected);
/// Expected: a whole number in [least, most], in decimal digits.
std::string mistake_in_number(const std::string& found, std::uint64_t least, std::uint64_t most);
/// Expected: a reason in words, on one line, for it is written into files.
std::string mistake_in_reason(const std::string& found);
/// Expected: BEFORE,AFTER,INCIDENTS: two numbers of steps or durations, and a number from 1 on.
std::string mistake_in_recorder(const std::string& found);
/// Expected: a or a::b, none of them reserved.
std::string mistake_in_namespace(const std::string& name);
/// Expected: seconds from 0.
std::string mistake_in_seconds(const std::string& found);

/// A first word that is neither an option nor a spec, but was meant as a command; empty where it
/// may be a spec.
std::string mistake_in_command(int argc, char** argv);

/// Of the options of the call together.
std::string mistake_in(const Call& call);

}  // namespace etlc::driver
