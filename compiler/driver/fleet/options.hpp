// Options of calls that are shared out among processes.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "driver/fleet/fleet.hpp"

namespace etlc::driver {

/// --shard, --part
void add_shard_options(CLI::App& app, ShardRequest& request);

/// "" where there is none.
std::string mistake_in_shard_call(const ShardRequest& request);

}  // namespace etlc::driver
