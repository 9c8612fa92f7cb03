// Options of `etlc embed`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "driver/embed.hpp"

namespace etlc::driver {

void add_embed_options(CLI::App& app, EmbedRequest& request);

/// What is wrong with them together; empty where nothing is.
std::string mistake_in_embed_call(const EmbedRequest& request);

}  // namespace etlc::driver
