// Queries: measurements, lets, counts, explanations and incidents of a step; encoders.
#include <cstring>

#include "artifacts/embedded.hpp"
#include "library/interface/call.hpp"

namespace etlc::library {

namespace {

etlc_status check_monitor(const Session& session, std::uint32_t monitor) {
    const std::size_t count = session.plan().monitors.size();
    return monitor < count ? etlc_status{ETLC_OK} : refuse_index("monitor", monitor, count);
}

etlc_status refuse_undecided(const Session& session, std::uint32_t monitor) {
    return refuse(ETLC_UNDECIDED, "monitor '{}' has no verdict yet",
                  session.plan().monitors[monitor].name);
}

static_assert(ETLC_REFERENCE_FRAMES == embedded::kReferenceFrames);

/// Returns the encoder of this name, of the only one where there is no name; null where the call
/// has been refused.
const check::Encoder* find_encoder(const Session& session, const char* name, etlc_status& refused) {
    const std::vector<check::Encoder>& encoders = session.model().encoders;
    if (name == nullptr && encoders.size() == 1) return &encoders[0];
    for (const check::Encoder& encoder : encoders)
        if (name != nullptr && encoder.name == name) return &encoder;
    if (encoders.empty())
        refused = refuse(ETLC_NO_SUCH, "the spec has no encoder");
    else if (name == nullptr)
        refused =
            refuse(ETLC_NO_SUCH, "the spec has {} encoders: name one of them", encoders.size());
    else
        refused = refuse(ETLC_NO_SUCH, "the spec has no encoder '{}'", name);
    return nullptr;
}

/// Calls `work(recorder)` where the spec was opened with a recorder.
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

etlc_status etlc_steps(etlc_session session, uint64_t* steps) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (steps == nullptr) return refuse_null("steps");
        *steps = opened.steps();
        return ETLC_OK;
    });
}

etlc_status etlc_position(etlc_session session, uint32_t monitor, uint64_t* position) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (position == nullptr) return refuse_null("position");
        if (const etlc_status failed = check_monitor(opened, monitor)) return failed;
        if (!opened.verdict(monitor).decided()) return refuse_undecided(opened, monitor);
        *position = opened.evaluator().position(monitor);
        return ETLC_OK;
    });
}

etlc_status etlc_measure(etlc_session session, uint32_t predicate, etlc_measured* measured) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (measured == nullptr) return refuse_null("measured");
        const std::size_t count = opened.model().predicates.size();
        if (predicate >= count) return refuse_index("predicate", predicate, count);
        const execute::Evaluator& evaluator = opened.evaluator();
        *measured = {evaluator.distance(predicate), evaluator.threshold(predicate),
                     evaluator.nearest(predicate)};
        return ETLC_OK;
    });
}

etlc_status etlc_let(etlc_session session, uint32_t let, etlc_verdict* verdict) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (verdict == nullptr) return refuse_null("verdict");
        const std::vector<etlmon::Verdict>& lets = opened.evaluator().lets();
        if (lets.empty())
            return refuse(ETLC_NOT_KEPT,
                          "no let is kept: open a spec that has some with "
                          "options.lets = 1");
        if (let >= lets.size()) return refuse_index("let", let, lets.size());
        std::memcpy(verdict, &lets[let], sizeof *verdict);
        return ETLC_OK;
    });
}

etlc_status etlc_count(etlc_session session, uint32_t input, etlc_counts* counts) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (counts == nullptr) return refuse_null("counts");
        const std::size_t inputs = opened.model().inputs.size();
        if (input >= inputs) return refuse_index("input", input, inputs);
        const execute::SampleCounts& of = opened.evaluator().sample_counts()[input];
        *counts = {of.missing + of.stale, of.out_of_range, of.held};
        return ETLC_OK;
    });
}

etlc_status etlc_explain(etlc_session session, uint32_t monitor, uint32_t format,
                         const char** text) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (text == nullptr) return refuse_null("text");
        if (const etlc_status failed = check_monitor(opened, monitor)) return failed;
        if (format > ETLC_JSON)
            return refuse(ETLC_WRONG_VALUE, "format is {}, expected ETLC_TEXT or ETLC_JSON",
                          format);
        if (!opened.verdict(monitor).decided()) return refuse_undecided(opened, monitor);
        if (const std::string why = opened.why_unexplained(); !why.empty())
            return refuse(ETLC_NOT_KEPT, "{}", why);
        *text = opened.explain(monitor, format == ETLC_JSON).c_str();
        return ETLC_OK;
    });
}

etlc_status etlc_encoder_difference(etlc_session session, const char* encoder, uint32_t frame,
                                    const float* embedding, size_t elements, double* difference) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        if (embedding == nullptr) return refuse_null("embedding");
        if (difference == nullptr) return refuse_null("difference");
        etlc_status refused = ETLC_OK;
        const check::Encoder* const found = find_encoder(opened, encoder, refused);
        if (found == nullptr) return refused;
        if (frame >= embedded::kReferenceFrames)
            return refuse(ETLC_NO_SUCH, "there is no reference frame {}, only {}", frame,
                          embedded::kReferenceFrames);
        const std::size_t dimension = found->references.size() / embedded::kReferenceFrames;
        if (dimension == 0)
            return refuse(ETLC_NOT_KEPT,
                          "what encoder '{}' makes of the reference frames is not known: run etlc "
                          "embed again",
                          found->name);
        if (elements != dimension)
            return refuse(ETLC_WRONG_NUMBER, "embedding has {} elements, encoder '{}' makes {}",
                          elements, found->name, dimension);
        *difference = embedded::relative_difference(
            embedding, &found->references[frame * dimension], dimension);
        return ETLC_OK;
    });
}

etlc_status etlc_incidents(etlc_session session, uint32_t* complete, uint32_t* lost) {
    return with_recorder(session, [&](execute::FlightRecorder& recorder) -> etlc_status {
        if (complete == nullptr) return refuse_null("complete");
        if (lost == nullptr) return refuse_null("lost");
        *complete = recorder.complete();
        *lost = recorder.lost();
        return ETLC_OK;
    });
}

etlc_status etlc_incident(etlc_session session, uint32_t incident, const void** bytes,
                          size_t* size) {
    return with_recorder(session, [&](execute::FlightRecorder& recorder) -> etlc_status {
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
    return with_recorder(session, [](execute::FlightRecorder& recorder) -> etlc_status {
        recorder.close();
        return ETLC_OK;
    });
}

etlc_status etlc_forget_incidents(etlc_session session) {
    return with_recorder(session, [](execute::FlightRecorder& recorder) -> etlc_status {
        recorder.forget();
        return ETLC_OK;
    });
}

}  // extern "C"
