// Batches of environments.
#include <unistd.h>

#include <vector>

#include "library/interface/call.hpp"

namespace etlc::library {

namespace {

etlc_status check_room(const Session& session, const Grids& samples, const void* verdicts,
                       std::size_t count) {
    if (const etlc_status failed = check_verdicts(verdicts, count)) return failed;
    const std::uint64_t monitors = session.plan().monitors.size();
    const std::uint64_t per_step = samples.rows * monitors;
    if (count % per_step == 0 && count / per_step == samples.steps) return ETLC_OK;
    return refuse(ETLC_WRONG_NUMBER, "there is room for {} verdicts, expected {} x {} x {}", count,
                  samples.rows, samples.steps, monitors);
}

etlc_status check_environments(const Batch& batch, std::uint64_t environments) {
    if (environments == batch.size()) return ETLC_OK;
    return refuse(ETLC_WRONG_NUMBER, "there are {} environments, expected the {} of the batch",
                  environments, batch.size());
}

/// Refuses a batch that this machine has too little memory for. Where the system promises memory
/// that it does not have, the program would be ended while it makes the states.
etlc_status check_memory(Session& opened, std::uint64_t environments) {
    std::vector<std::uint8_t> state;
    opened.evaluator().state().write(state);
    const std::uint64_t bytes = sizeof(execute::State) + state.size();
    const long pages = sysconf(_SC_PHYS_PAGES);
    const long page = sysconf(_SC_PAGE_SIZE);
    const auto memory = static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page);
    if (pages <= 0 || page <= 0 || environments <= memory / bytes) return ETLC_OK;
    return refuse(ETLC_OUT_OF_MEMORY,
                  "{} environments take {} MB or more, and this machine has {} MB", environments,
                  environments * bytes >> 20U, memory >> 20U);
}

/// Calls `work(environment)` for those chosen.
template <class Work>
void for_each_of(const Batch& batch, const std::uint8_t* which, const Work& work) {
    for (std::uint64_t e = 0; e < batch.size(); ++e)
        if (which == nullptr || which[e] != 0) work(e);
}

}  // namespace

etlc_status check_grids(const Session& session, const Grids& samples, std::size_t grid_count,
                        std::uint32_t threads, const void* verdicts, std::size_t count) {
    if (const etlc_status failed = check_count(session, samples.grids, grid_count, "grids"))
        return failed;
    if (threads > kMostThreads)
        return refuse(ETLC_WRONG_VALUE, "threads is {}, expected at most {}", threads,
                      kMostThreads);
    if (const etlc_status failed = check_room(session, samples, verdicts, count)) return failed;
    const std::vector<check::Input>& inputs = session.model().inputs;
    for (std::size_t i = 0; i < inputs.size(); ++i)
        if (const etlc_status failed =
                check_grid(inputs[i], samples.grids[i], samples.rows, samples.steps))
            return failed;
    return ETLC_OK;
}

etlc_status check_none_ended(const Batch& batch) {
    for (std::uint64_t e = 0; e < batch.size(); ++e)
        if (batch.is_ended(e))
            return refuse(ETLC_ENDED,
                          "the episode of environment {} has ended with etlc_finish_batch(): "
                          "etlc_reset_batch() begins another one",
                          e);
    return ETLC_OK;
}

}  // namespace etlc::library

using namespace etlc;
using namespace etlc::library;

extern "C" {

etlc_status etlc_open_batch(etlc_session session, uint64_t environments, etlc_session* batch) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        if (environments == 0 || environments > kMostRows)
            return refuse(ETLC_WRONG_NUMBER,
                          "there are {} environments, expected a number from 1 to {}", environments,
                          kMostRows);
        if (const etlc_status failed = check_memory(opened, environments)) return failed;
        return give_session(batch, "batch", [&] {
            return std::make_unique<Session>(opened.program(),
                                             Batch(opened.program(), environments));
        });
    });
}

etlc_status etlc_run_batch(etlc_session batch, const etlc_grid* grids, size_t grid_count,
                           uint64_t steps, uint32_t threads, etlc_verdict* verdicts,
                           size_t verdict_count) {
    return with_batch(batch, [&](Batch& of, Session& opened) -> etlc_status {
        if (const etlc_status failed = check_none_ended(of)) return failed;
        const Grids samples{grids, of.size(), steps};
        if (const etlc_status failed =
                check_grids(opened, samples, grid_count, threads, verdicts, verdict_count))
            return failed;
        of.run(samples, threads_for(threads, samples), verdicts);
        return ETLC_OK;
    });
}

etlc_status etlc_reset_batch(etlc_session batch, const uint8_t* which, uint64_t environments) {
    return with_batch(batch, [&](Batch& of, Session&) -> etlc_status {
        if (const etlc_status failed = check_environments(of, environments)) return failed;
        for_each_of(of, which, [&](std::uint64_t e) { of.reset(e); });
        return ETLC_OK;
    });
}

etlc_status etlc_restart_batch(etlc_session batch, uint32_t monitor, const uint8_t* which,
                               uint64_t environments) {
    return with_batch(batch, [&](Batch& of, Session& opened) -> etlc_status {
        if (const etlc_status failed = check_environments(of, environments)) return failed;
        if (const etlc_status failed = check_restarts(opened, monitor)) return failed;
        for_each_of(of, which, [&](std::uint64_t e) { of.restart(e, monitor); });
        return ETLC_OK;
    });
}

etlc_status etlc_finish_batch(etlc_session batch, const uint8_t* which, uint64_t environments,
                              etlc_verdict* verdicts, size_t verdict_count) {
    return with_batch(batch, [&](Batch& of, Session& opened) -> etlc_status {
        if (const etlc_status failed = check_environments(of, environments)) return failed;
        const Grids one_step{nullptr, of.size(), 1};
        if (const etlc_status failed = check_room(opened, one_step, verdicts, verdict_count))
            return failed;
        const std::size_t monitors = opened.plan().monitors.size();
        for_each_of(of, which, [&](std::uint64_t e) { of.finish(e, verdicts + e * monitors); });
        return ETLC_OK;
    });
}

etlc_status etlc_steps_batch(etlc_session batch, uint64_t* steps, uint64_t environments) {
    return with_batch(batch, [&](Batch& of, Session&) -> etlc_status {
        if (const etlc_status failed = check_environments(of, environments)) return failed;
        if (steps == nullptr) return refuse_null("steps");
        for (std::uint64_t e = 0; e < of.size(); ++e) steps[e] = of.steps(e);
        return ETLC_OK;
    });
}

etlc_status etlc_measure_batch(etlc_session batch, uint32_t predicate, etlc_measured* measured,
                               uint64_t environments) {
    return with_batch(batch, [&](Batch& of, Session& opened) -> etlc_status {
        if (const etlc_status failed = check_environments(of, environments)) return failed;
        if (measured == nullptr) return refuse_null("measured");
        const std::size_t count = opened.model().predicates.size();
        if (predicate >= count) return refuse_index("predicate", predicate, count);
        for (std::uint64_t e = 0; e < of.size(); ++e) {
            const execute::State& state = of.state(e);
            const etlmon::Measured& found = state.measured[predicate];
            measured[e] = {found.delta, state.thresholds[predicate], found.nearest};
        }
        return ETLC_OK;
    });
}

etlc_status etlc_copy_environment(etlc_session batch, uint64_t environment, etlc_session* copy) {
    return with_batch(batch, [&](Batch& of, Session& opened) -> etlc_status {
        if (environment >= of.size())
            return refuse(ETLC_NO_SUCH, "there is no environment {}: the batch has {} of them",
                          environment, of.size());
        return give_session(copy, "copy", [&] {
            return std::make_unique<Session>(opened.program(), of, environment);
        });
    });
}

}  // extern "C"
