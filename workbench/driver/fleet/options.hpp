// Options of calls that are shared out among processes.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "driver/fleet/fleet.hpp"

namespace etlc::driver {

/// --shard
void add_shard_option(CLI::App& app, ShardRequest& request, const std::string& description);

/// --shard, --part
void add_shard_options(CLI::App& app, ShardRequest& request);

/// "" where there is none.
std::string mistake_in_shard_call(const ShardRequest& request);

}  // namespace etlc::driver
