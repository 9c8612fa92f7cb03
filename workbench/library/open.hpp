// From a spec's file to its plan, for all who step one: libetlc, `etlc run` and the other commands.
#pragma once

#include <optional>
#include <string>

#include "check/check.hpp"
#include "diag/diag.hpp"
#include "pipeline/compile.hpp"
#include "source/source.hpp"

namespace etlc::library {

/// The file's text; of one that cannot be read nothing, and the sink now says why not.
bool read_spec(const std::string& path, source::File& file, diag::Sink& sink);

/// Through all stages. Nothing where there was an error.
std::optional<pipeline::Compiled> compile(const source::File& file, const check::Options& check,
                                          const pipeline::Options& options, diag::Sink& sink);

}  // namespace etlc::library
