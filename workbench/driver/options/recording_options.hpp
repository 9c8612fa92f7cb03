// Options that say which recordings a command reads.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "data/traces/trace.hpp"

namespace etlc::driver {

/// --map
void add_map_option(CLI::App& app, data::NamesInFile& names);

/// --data, and how episodes are found and read.
void add_episode_options(CLI::App& app, std::vector<std::string>& data, std::string& groups,
                         std::string& allow_overlap, unsigned& jobs);

/// --folds
void add_folds_option(CLI::App& app, std::uint32_t& folds, const std::string& help);

}  // namespace etlc::driver
