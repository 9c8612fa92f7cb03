// Copies sessions, looks ahead of them, saves and loads their states.
#include <vector>

#include "library/interface/call.hpp"
#include "library/interface/grids.hpp"

namespace etlc::library {

namespace {

etlc_status check_not_ended(const Session& session) {
    if (!session.is_ended()) return ETLC_OK;
    return refuse(ETLC_ENDED,
                  "the episode has ended with etlc_finish(): etlc_reset() begins another one");
}

}  // namespace

}  // namespace etlc::library

using namespace etlc;
using namespace etlc::library;

extern "C" {

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
                batch == nullptr ? check_not_ended(opened) : check_none_ended(*batch))
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
