// The description of the spec of a session.
#include <algorithm>
#include <string>

#include "check/model/fingerprint.hpp"
#include "data/text/text.hpp"
#include "library/interface/call.hpp"
#include "library/program.hpp"

namespace etlc::library {

namespace {

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
