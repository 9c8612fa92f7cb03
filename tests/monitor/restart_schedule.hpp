// Runs the reference with restarts of monitors.
#pragma once

#include <cstddef>

#include "check/model/model.hpp"
#include "compare.hpp"
#include "driver/restarts_before.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

/// The restarts of the observed run, by the program and by final verdicts. A monitor's bounds may
/// be tighter than the definition's, and its verdict final earlier: then the reference must follow
/// it.
inline reference::Requests restarts_of(const check::Model& model, const Observed& observed) {
    const std::size_t steps = observed.verdicts.size();
    reference::Requests requests(steps, std::vector<bool>(model.monitors.size()));
    for (std::size_t step = 0; step < steps; ++step)
        for (std::size_t m = 0; m < model.monitors.size(); ++m) {
            const check::Restarts restarts = model.monitors[m].restarts;
            if (restarts == check::Restarts::never) continue;
            const bool was_final = restarts == check::Restarts::when_final && step > 0 &&
                                   observed.verdicts[step - 1][m].final;
            requests[step][m] = restarts_before(step, m) || was_final;
        }
    return requests;
}

/// Returns the reference's output for such a run.
inline reference::Run expected_run(const check::Model& model, const reference::Trace& trace,
                                   const Observed& observed,
                                   check::Values values = check::Values::robustness) {
    return reference::evaluate(model, trace, values, {}, restarts_of(model, observed));
}

}  // namespace etlc::tests
