// Options whose values have a form of their own.
// Takes: the words behind the option. Gives: what they mean, in the call; or what is wrong with
// them, empty where nothing is.
#pragma once

#include <string>
#include <vector>

#include "driver/options/call.hpp"

namespace etlc::driver {

/// --set NAME=VALUE
std::string read_settings(Call& call, const std::vector<std::string>& words);
/// --map NAME=OTHER
std::string read_names(Call& call, const std::vector<std::string>& words);
/// --camera NAME, of all inputs, or INPUT=NAME
std::string read_cameras(Call& call, const std::vector<std::string>& words);
/// --shard 3/64; in a rank of an MPI job -/64
std::string read_shard(Call& call, const std::vector<std::string>& words);
/// --recorder BEFORE,AFTER,INCIDENTS, which has been checked
std::string read_recorder(Call& call, const std::vector<std::string>& words);
/// --at SECONDS, which has been checked
std::string read_seconds(Call& call, const std::vector<std::string>& words);
/// --suggest [PREDICATE...]
std::string read_suggest(Call& call, const std::vector<std::string>& words);

}  // namespace etlc::driver
