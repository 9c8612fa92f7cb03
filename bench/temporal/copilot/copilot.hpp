// Some of the formulas in Copilot (copilot/Monitors.hs), if Copilot was installed for this build.
// Takes: a formula's title. Gives: its monitor, which Copilot keeps in global variables. Keeps
// true: robustness only, of this step, in floats.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "signals.hpp"

namespace bench {

/// Takes one step on the samples i of the signals; returns its robustness.
using CopilotStep = float (*)(const Signals& signals, std::size_t i);

std::optional<CopilotStep> copilot_step(const std::string& title);

}  // namespace bench
