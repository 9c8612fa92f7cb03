// Steps the monitors of a session; copies sessions, looks ahead of them, saves and loads their
// states.

#include <cmath>
#include <cstring>
#include <vector>

#include "library/interface/call.hpp"

namespace etlc::library {

namespace {

static_assert(sizeof(etlc_verdict) == sizeof(etlmon::Verdict));
static_assert(ETLC_SATISFIED == etlmon::Verdict::kSatisfied &&
              ETLC_VIOLATED == etlmon::Verdict::kViolated &&
              ETLC_DECIDED == etlmon::Verdict::kDecided && ETLC_FINAL == etlmon::Verdict::kFinal);

etlc_status check_room(const Session& session, const void* verdicts, std::size_t count,
                       std::uint64_t steps) {
    const std::size_t monitors = session.plan().monitors.size();
    if (const etlc_status failed = check_verdicts(verdicts, count)) return failed;
    if (count / monitors == steps && count % monitors == 0) return ETLC_OK;
    return refuse(ETLC_WRONG_NUMBER, "there is room for {} verdicts, expected {} x {}", count,
                  steps, monitors);
}

etlc_status check_open(const Session& session) {
    if (!session.is_ended()) return ETLC_OK;
    return refuse(ETLC_ENDED,
                  "the episode has ended with etlc_finish(): etlc_reset() begins another one");
}

void give(const std::vector<etlmon::Verdict>& from, etlc_verdict* to) {
    std::memcpy(to, from.data(), from.size() * sizeof *to);
}

}  // namespace

}  // namespace etlc::library

using namespace etlc;
using namespace etlc::library;

extern "C" {

etlc_status etlc_step(etlc_session session, const etlc_sample* samples, size_t sample_count,
                      etlc_verdict* verdicts, size_t verdict_count) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (const etlc_status failed = check_open(opened)) return failed;
        if (const etlc_status failed = check_count(opened, samples, sample_count, "samples"))
            return failed;
        if (const etlc_status failed = check_room(opened, verdicts, verdict_count, 1))
            return failed;
        const std::vector<check::Input>& inputs = opened.model().inputs;
        for (std::size_t i = 0; i < inputs.size(); ++i)
            if (const etlc_status failed = check_sample(inputs[i], samples[i])) return failed;
        for (Index i = 0; i < inputs.size(); ++i)
            if (opened.program()->is_used(i)) take(inputs[i], samples[i].data, opened.sample(i));
        give(opened.step(), verdicts);
        return ETLC_OK;
    });
}

etlc_status etlc_run(etlc_session session, const etlc_column* columns, size_t column_count,
                     uint64_t steps, etlc_verdict* verdicts, size_t verdict_count) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (const etlc_status failed = check_open(opened)) return failed;
        if (const etlc_status failed = check_count(opened, columns, column_count, "columns"))
            return failed;
        if (const etlc_status failed = check_room(opened, verdicts, verdict_count, steps))
            return failed;
        const std::vector<check::Input>& inputs = opened.model().inputs;
        for (std::size_t i = 0; i < inputs.size(); ++i)
            if (const etlc_status failed = check_grid(inputs[i], grid_of(columns[i]), 1, steps))
                return failed;
        for (std::uint64_t step = 0; step < steps; ++step) {
            for (Index i = 0; i < inputs.size(); ++i)
                if (opened.program()->is_used(i))
                    take(inputs[i], at(grid_of(columns[i]), steps, 0, step), opened.sample(i));
            give(opened.step(), verdicts);
            verdicts += opened.plan().monitors.size();
        }
        return ETLC_OK;
    });
}

etlc_status etlc_finish(etlc_session session, etlc_verdict* verdicts, size_t verdict_count) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (const etlc_status failed = check_room(opened, verdicts, verdict_count, 1))
            return failed;
        give(opened.finish(), verdicts);
        return ETLC_OK;
    });
}

etlc_status etlc_end_episode(etlc_session session) {
    return with_session(session, [](Session& opened) -> etlc_status {
        opened.evaluator().end_episode();
        return ETLC_OK;
    });
}

etlc_status etlc_reset(etlc_session session) {
    return with_session(session, [](Session& opened) -> etlc_status {
        opened.reset();
        return ETLC_OK;
    });
}

etlc_status etlc_restart(etlc_session session, uint32_t monitor) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (const etlc_status failed = check_restarts(opened, monitor)) return failed;
        opened.restart(monitor);
        return ETLC_OK;
    });
}

etlc_status etlc_observe(etlc_session session, uint32_t predicate, float distance, uint32_t truth) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        const std::vector<check::Predicate>& predicates = opened.model().predicates;
        if (predicate >= predicates.size())
            return refuse_index("predicate", predicate, predicates.size());
        if (!predicates[predicate].threshold.adaptation)
            return refuse(ETLC_WRONG_VALUE, "the threshold of '{}' is not adaptive",
                          opened.program()->predicate_name(predicate));
        if (!std::isfinite(distance))
            return refuse(ETLC_WRONG_VALUE, "distance is {}, expected a finite number", distance);
        if (truth > 1) return refuse(ETLC_WRONG_VALUE, "truth is {}, expected 0 or 1", truth);
        opened.observe(predicate, distance, truth == 1);
        return ETLC_OK;
    });
}

etlc_status etlc_copy(etlc_session session, etlc_session* copy) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        return give_session(copy, "copy", [&] { return std::make_unique<Session>(opened); });
    });
}

etlc_status etlc_ahead(etlc_session session, const etlc_grid* grids, size_t grid_count,
                       uint64_t plans, uint64_t steps, uint32_t threads, etlc_verdict* verdicts,
                       size_t verdict_count) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        const Batch* const batch = opened.batch();
        if (const etlc_status failed =
                batch == nullptr ? check_open(opened) : check_none_ended(*batch))
            return failed;
        const std::uint64_t environments = batch == nullptr ? 1 : batch->size();
        if (plans == 0 || plans > kMostRows / environments)
            return refuse(ETLC_WRONG_NUMBER, "there are {} plans, expected a number from 1 to {}",
                          plans, kMostRows / environments);
        const Grids samples{grids, environments * plans, steps};
        if (const etlc_status failed =
                check_grids(opened, samples, grid_count, threads, verdicts, verdict_count))
            return failed;
        if (steps == 0) return ETLC_OK;
        std::vector<const execute::State*> states;
        for (std::uint64_t e = 0; e < environments; ++e)
            states.push_back(batch == nullptr ? &opened.evaluator().state() : &batch->state(e));
        look_ahead(opened.program(), states, plans, samples, threads_for(threads, samples),
                   verdicts);
        return ETLC_OK;
    });
}

etlc_status etlc_save(etlc_session session, const void** bytes, size_t* size) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        if (bytes == nullptr) return refuse_null("bytes");
        if (size == nullptr) return refuse_null("size");
        if (opened.recorder() != nullptr)
            return refuse(ETLC_NOT_KEPT,
                          "the state of a session with a recorder is not saved: its incidents are "
                          "bytes of their own (etlc_incident())");
        const std::vector<std::uint8_t>& saved = opened.save();
        *bytes = saved.data();
        *size = saved.size();
        return ETLC_OK;
    });
}

etlc_status etlc_load(etlc_session session, const void* bytes, size_t size) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        if (bytes == nullptr) return refuse_null("bytes");
        if (opened.recorder() != nullptr)
            return refuse(ETLC_NOT_KEPT, "a session with a recorder takes no state");
        const std::string why = opened.load({static_cast<const std::uint8_t*>(bytes), size});
        return why.empty() ? etlc_status{ETLC_OK} : refuse(ETLC_WRONG_VALUE, "{}", why);
    });
}

}  // extern "C"
