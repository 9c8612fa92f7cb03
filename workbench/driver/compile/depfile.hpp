// What an output depends on, for make and ninja.
#pragma once

#include <string>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::driver {

/// "monitor.hpp: spec.etl targets/a.npy"; a failure where a name cannot stand there so that both
/// read it.
diag::Result<std::string> dependency_rule(const std::string& output, const std::string& spec,
                                          const std::vector<std::string>& files);

}  // namespace etlc::driver
