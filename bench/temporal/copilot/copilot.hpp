// Some of the formulas as Copilot has them (copilot/Monitors.hs), where Copilot was there when this
// was built. Takes: a formula's title. Gives: its monitor, which Copilot keeps in global variables.
// Keeps true: robustness alone, of this step, in floats.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "signals.hpp"

namespace bench {

/// One step on the samples i of the signals; its robustness.
using CopilotStep = float (*)(const Signals& signals, std::size_t i);

std::optional<CopilotStep> copilot_step(const std::string& title);

}  // namespace bench
