// What the flight recorder of a session holds.
#include "library/call.hpp"

namespace etlc::library {

namespace {

/// `work(recorder)`, where the spec was opened with one.
template <class Work>
etlc_status with_recorder(etlc_session number, const Work& work) noexcept {
    return with_session(number, [&](Session& opened) -> etlc_status {
        if (opened.recorder() != nullptr) return work(*opened.recorder());
        return refuse(ETLC_NOT_KEPT,
                      "no incident is kept: open the spec with options.recorder, as \"2s,1s,4\"");
    });
}

}  // namespace

}  // namespace etlc::library

using namespace etlc;
using namespace etlc::library;

extern "C" {

etlc_status etlc_incidents(etlc_session session, uint32_t* complete, uint32_t* lost) {
    return with_recorder(session, [&](plan::FlightRecorder& recorder) -> etlc_status {
        if (complete == nullptr) return refuse_null("complete");
        if (lost == nullptr) return refuse_null("lost");
        *complete = recorder.complete();
        *lost = recorder.lost();
        return ETLC_OK;
    });
}

etlc_status etlc_incident(etlc_session session, uint32_t incident, const void** bytes,
                          size_t* size) {
    return with_recorder(session, [&](plan::FlightRecorder& recorder) -> etlc_status {
        if (bytes == nullptr) return refuse_null("bytes");
        if (size == nullptr) return refuse_null("size");
        if (incident >= recorder.complete())
            return refuse(ETLC_NO_SUCH, "there is no incident {}: {} of them are complete",
                          incident, recorder.complete());
        const std::vector<std::uint8_t>& written = recorder.write(incident);
        *bytes = written.data();
        *size = written.size();
        return ETLC_OK;
    });
}

etlc_status etlc_close_incidents(etlc_session session) {
    return with_recorder(session, [](plan::FlightRecorder& recorder) -> etlc_status {
        recorder.close();
        return ETLC_OK;
    });
}

etlc_status etlc_forget_incidents(etlc_session session) {
    return with_recorder(session, [](plan::FlightRecorder& recorder) -> etlc_status {
        recorder.forget();
        return ETLC_OK;
    });
}

}  // extern "C"
