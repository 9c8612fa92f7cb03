// Queries: measurements, lets, counts, explanations and incidents of a step; encoders; the
// description of the spec of a session.

#include <algorithm>
#include <cstring>
#include <string>

#include "artifacts/embedded.hpp"
#include "check/model/fingerprint.hpp"
#include "data/text/text.hpp"
#include "library/interface/call.hpp"
#include "library/program.hpp"

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

std::uint32_t restarts_of(const plan::Monitor& monitor) {
    switch (monitor.restarts) {
        case check::Restarts::on_request: return ETLC_ON_REQUEST;
        case check::Restarts::when_final: return ETLC_WHEN_FINAL;
        case check::Restarts::never: break;
    }
    return ETLC_NEVER;
}

std::size_t count_of(Session& session, std::uint32_t kind) {
    switch (kind) {
        case ETLC_INPUTS: return session.model().inputs.size();
        case ETLC_MONITORS: return session.plan().monitors.size();
        case ETLC_PREDICATES: return session.model().predicates.size();
        default: return session.plan().lets.size();
    }
}

const std::string& name_of(Session& session, std::uint32_t kind, Index index) {
    switch (kind) {
        case ETLC_INPUTS: return session.model().inputs[index].name;
        case ETLC_MONITORS: return session.plan().monitors[index].name;
        case ETLC_PREDICATES: return session.program()->predicate_name(index);
        default: return session.model().lets[session.plan().lets[index].index].name;
    }
}

constexpr const char* kKinds[] = {"input", "monitor", "predicate", "let"};

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

etlc_status etlc_inner_threshold(etlc_session session, uint32_t predicate, float* threshold) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        if (threshold == nullptr) return refuse_null("threshold");
        const std::vector<check::Predicate>& predicates = opened.model().predicates;
        if (predicate >= predicates.size())
            return refuse_index("predicate", predicate, predicates.size());
        *threshold = predicates[predicate].threshold.inner.value_or(etlmon::kMissing);
        return ETLC_OK;
    });
}

etlc_status etlc_drifted(etlc_session session, const char* name, etlc_drift* drift) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (name == nullptr) return refuse_null("name");
        if (const etlc_status failed = check_struct(drift, "drift")) return failed;
        const std::vector<Index>& drifts = opened.plan().drifts;
        for (std::size_t i = 0; i < drifts.size(); ++i) {
            if (opened.model().drifts[drifts[i]].name != name) continue;
            const etlmon::DriftCells& cells = opened.evaluator().drift_cells(i);
            const etlmon::Drift& found = opened.evaluator().drift(i);
            drift->is_alarm = found.alarm(cells) ? 1 : 0;
            drift->episodes = found.state().episodes();
            drift->wealth = found.state().wealth();
            drift->limit = cells.limit;
            std::copy_n(found.state().counts, etlmon::kDriftCells, drift->counts);
            return ETLC_OK;
        }
        return refuse(ETLC_NO_SUCH, "the spec has no drift {}", data::in_quotes(name));
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

etlc_status etlc_describe(etlc_session session, etlc_description* description) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        if (const etlc_status failed = check_struct(description, "description")) return failed;
        const check::Model& model = opened.model();
        const check::Fingerprint origin = check::fingerprint(model);
        etlc_description& out = *description;
        out.inputs = static_cast<std::uint32_t>(model.inputs.size());
        out.monitors = static_cast<std::uint32_t>(opened.plan().monitors.size());
        out.predicates = static_cast<std::uint32_t>(model.predicates.size());
        out.lets = static_cast<std::uint32_t>(opened.plan().lets.size());
        out.horizon = 0;
        for (const plan::Monitor& monitor : opened.plan().monitors)
            out.horizon = std::max(out.horizon, monitor.horizon);
        out.step_seconds = model.step_seconds;
        out.state_bytes = opened.plan().cost.state_bytes;
        out.spec_hash = origin.spec;
        out.data_hash = origin.data;
        out.thresholds_hash = origin.thresholds;
        out.name = model.name.c_str();
        out.warnings = opened.program()->warnings().c_str();
        return ETLC_OK;
    });
}

etlc_status etlc_describe_input(etlc_session session, uint32_t input, etlc_input* description) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        if (const etlc_status failed = check_struct(description, "description")) return failed;
        const std::vector<check::Input>& inputs = opened.model().inputs;
        if (input >= inputs.size()) return refuse_index("input", input, inputs.size());
        const check::Input& of = inputs[input];
        etlc_input& out = *description;
        out.type = type_of(of);
        out.dimension = of.dimension;
        out.hold = of.hold;
        out.low = of.range.low;
        out.high = of.range.high;
        out.scale = of.scale;
        out.is_embedding = of.is_embedding() ? 1 : 0;
        out.is_used = opened.program()->is_used(input) ? 1 : 0;
        out.stale_after = of.stale_after;
        out.name = of.name.c_str();
        return ETLC_OK;
    });
}

etlc_status etlc_describe_monitor(etlc_session session, uint32_t monitor,
                                  etlc_monitor* description) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        if (const etlc_status failed = check_struct(description, "description")) return failed;
        const std::vector<plan::Monitor>& monitors = opened.plan().monitors;
        if (monitor >= monitors.size()) return refuse_index("monitor", monitor, monitors.size());
        const plan::Monitor& of = monitors[monitor];
        etlc_monitor& out = *description;
        out.is_sliding = of.sliding ? 1 : 0;
        out.restarts = restarts_of(of);
        out.horizon = of.horizon;
        out.name = of.name.c_str();
        out.formula = opened.program()->formula(monitor).c_str();
        return ETLC_OK;
    });
}

etlc_status etlc_describe_predicate(etlc_session session, uint32_t predicate,
                                    etlc_predicate* description) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        if (const etlc_status failed = check_struct(description, "description")) return failed;
        const std::vector<check::Predicate>& predicates = opened.model().predicates;
        if (predicate >= predicates.size())
            return refuse_index("predicate", predicate, predicates.size());
        const check::Predicate& of = predicates[predicate];
        etlc_predicate& out = *description;
        out.is_measured = opened.program()->is_measured(predicate) ? 1 : 0;
        out.is_adaptive = of.threshold.adaptation ? 1 : 0;
        out.has_nearest = of.plain_distance() ? 1 : 0;
        out.name = opened.program()->predicate_name(predicate).c_str();
        out.text = opened.program()->predicate_text(predicate).c_str();
        return ETLC_OK;
    });
}

etlc_status etlc_describe_let(etlc_session session, uint32_t let, const char** name) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        if (name == nullptr) return refuse_null("name");
        const std::size_t count = count_of(opened, ETLC_LETS);
        if (let >= count) return refuse_index("let", let, count);
        *name = name_of(opened, ETLC_LETS, let).c_str();
        return ETLC_OK;
    });
}

etlc_status etlc_find(etlc_session session, uint32_t kind, const char* name, uint32_t* index) {
    return with_any(session, [&](Session& opened) -> etlc_status {
        if (name == nullptr) return refuse_null("name");
        if (index == nullptr) return refuse_null("index");
        if (kind > ETLC_LETS)
            return refuse(ETLC_WRONG_VALUE, "kind is {}, expected a number from 0 to {}", kind,
                          static_cast<int>(ETLC_LETS));
        const std::size_t count = count_of(opened, kind);
        for (Index i = 0; i < count; ++i) {
            if (name_of(opened, kind, i) != name) continue;
            *index = i;
            return ETLC_OK;
        }
        return refuse(ETLC_NO_SUCH, "the spec has no {} {}", kKinds[kind], data::in_quotes(name));
    });
}

}  // extern "C"
