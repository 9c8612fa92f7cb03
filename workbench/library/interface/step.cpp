// Steps the monitors of a session.
#include <cmath>
#include <cstring>

#include "library/interface/call.hpp"
#include "library/interface/checks.hpp"
#include "library/samples.hpp"

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
            if (const etlc_status failed = check_column(inputs[i], columns[i], steps))
                return failed;
        for (std::uint64_t step = 0; step < steps; ++step) {
            for (Index i = 0; i < inputs.size(); ++i)
                if (opened.program()->is_used(i))
                    take(inputs[i], at(columns[i], step), opened.sample(i));
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

}  // extern "C"
