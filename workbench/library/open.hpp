// Reads and compiles a spec, for libetlc and the commands.
#pragma once

#include <optional>
#include <string>

#include "check/check.hpp"
#include "diag/diag.hpp"
#include "pipeline/compile.hpp"
#include "source/source.hpp"

namespace etlc::library {

/// Reads the file of a spec; reports an error where that fails.
bool read_spec(const std::string& path, source::File& file, diag::Sink& sink);

/// Compiles a spec through all stages; nothing where there was an error.
std::optional<pipeline::Compiled> compile(const source::File& file, const check::Options& check,
                                          const pipeline::Options& options, diag::Sink& sink);

}  // namespace etlc::library
