#include "lsp/answers/answers.hpp"

#include <fmt/format.h>

#include <cmath>

#include "check/guarantees/guarantees.hpp"
#include "plan/budget/budget.hpp"

namespace etlc::lsp {

namespace {

using check::Index;
using check::Model;
using Sentences = std::vector<std::string>;

std::string type_of(const check::Input& input) {
    switch (input.type) {
        case check::InputType::boolean: return "a bool";
        case check::InputType::scalar: return "a scalar in float32";
        case check::InputType::f32:
            return fmt::format("an embedding of dimension {} in float32", input.dimension);
        case check::InputType::f16:
            return fmt::format("an embedding of dimension {} in float16", input.dimension);
        case check::InputType::i8: break;
    }
    return fmt::format("an embedding of dimension {} in int8, times {}", input.dimension,
                       input.scale);
}

Sentences about(const Model& model, const check::Input& input) {
    Sentences facts{"Input: " + type_of(input) + "."};
    if (input.has_range)
        facts.push_back(fmt::format("A sample outside [{}, {}] counts as missing.", input.range.low,
                                    input.range.high));
    if (input.hold > 0)
        facts.push_back(fmt::format("The last sample stands in for up to {} missing ones in a row.",
                                    input.hold));
    if (input.stale_after > 0)
        facts.push_back(
            fmt::format("A sample counts as missing when it has come more than {} in a row.",
                        diag::counted(input.stale_after, "time")));
    if (input.missing)
        facts.push_back(fmt::format("Where it is missing it counts as {}.", *input.missing));
    if (input.encoder < model.encoders.size())
        facts.push_back(fmt::format("Made of images by '{}'.", model.encoders[input.encoder].name));
    return facts;
}

std::string origin_in_words(const std::string& origin) {
    if (origin == "literal") return "written in the spec";
    return origin == "fitted" ? origin : "from " + origin;
}

Sentences about(const Model& model, const check::Target& target) {
    Sentences facts{fmt::format("Target: {} of dimension {}, {}.",
                                diag::counted(target.rows, "row"), target.dimension,
                                origin_in_words(target.origin))};
    if (target.space < model.points.size())
        facts.push_back(
            fmt::format("Its rows are in the space of {}.", model.points[target.space].text));
    if (target.fitted < model.fitted.size() && !model.fitted[target.fitted].filled)
        facts.emplace_back("It is not fitted yet: 'etlc fit' finds it.");
    return facts;
}

Sentences about(const Model& model, const check::Projection& projection) {
    Sentences facts{fmt::format("Projection: from dimension {} to {}, {}.", projection.dimension,
                                projection.rows, origin_in_words(projection.origin))};
    if (projection.fitted < model.fitted.size() && !model.fitted[projection.fitted].filled)
        facts.emplace_back("It is not fitted yet: 'etlc fit' finds it.");
    return facts;
}

Sentences about(const check::Encoder& encoder) {
    Sentences facts{fmt::format("Encoder: the model {}.", encoder.model)};
    if (encoder.dimension > 0)
        facts.push_back(fmt::format("It gives {} numbers.", encoder.dimension));
    if (encoder.fingerprint.empty())
        facts.emplace_back("'etlc embed' has not been run with it yet.");
    return facts;
}

std::string shown(float number) {
    return fmt::format("{}", number);
}

Sentences about(const Model& model, Index index) {
    const check::Predicate& predicate = model.predicates[index];
    const check::Threshold& threshold = predicate.threshold;
    Sentences facts;
    const bool known = !std::isnan(threshold.value);
    facts.push_back(fmt::format("Predicate: {}{}.", predicate.text,
                                known ? shown(threshold.value) : threshold.text));
    facts.push_back(
        known ? fmt::format("Threshold {}: {}.", shown(threshold.value), check::origin(threshold))
              : fmt::format("Threshold: {}, not there yet; 'etlc calibrate' finds it.",
                            threshold.text));
    if (known && threshold.adaptation)
        facts.push_back(fmt::format("Of T labelled positive frames it misses at most {}.",
                                    check::miss_bound(predicate)));
    if (known && !predicate.equality())
        facts.push_back(fmt::format("Robustness in [{}, {}].", shown(predicate.robustness.low),
                                    shown(predicate.robustness.high)));
    if (predicate.missing)
        facts.push_back(
            fmt::format("Where a sample is missing it counts as {}.", *predicate.missing));
    return facts;
}

std::string kind_of(const check::Monitor& monitor) {
    if (monitor.sliding)
        return fmt::format("Sliding monitor: about every step, {} late.",
                           diag::counted(monitor.horizon, "step"));
    switch (monitor.restarts) {
        case check::Restarts::never: break;
        case check::Restarts::on_request:
            return "Restartable monitor: about the step at which the program last restarted it.";
        case check::Restarts::when_final:
            return "Repeating monitor: about the present cycle, the next after each final verdict.";
    }
    return "Monitor: about the first step.";
}

Sentences about(const Model& model, const check::Monitor& monitor, bool complete,
                const Planned* planned) {
    Sentences facts{kind_of(monitor)};
    if (complete) {
        for (const check::Claim& claim : check::claims(model, monitor)) {
            if (!claim.part.empty())
                facts.push_back(fmt::format("Part {}: {}.", claim.part, check::text(claim)));
            else if (claim.kind == check::Claim::Kind::nothing)
                facts.push_back(fmt::format("No guarantee: {}.", claim.why));
            else
                facts.push_back(fmt::format("Guarantee: {}.", check::text(claim)));
        }
    }
    if (monitor.calibration && complete)
        facts.push_back(fmt::format("Robustness less {}: {}.",
                                    shown(monitor.calibration->threshold.value),
                                    check::origin(monitor.calibration->threshold)));
    if (planned == nullptr || !planned->compiled) return facts;
    const plan::Plan& plan = planned->compiled->plan;
    for (std::size_t m = 0; m < plan.monitors.size() && m < plan.monitor_costs.size(); ++m)
        if (plan.monitors[m].name == monitor.name)
            facts.push_back(fmt::format("Budget: {}.", plan::in_words(plan.monitor_costs[m])));
    return facts;
}

Sentences about(const Model& model, const check::Let& let) {
    if (let.formula >= model.formulas.size()) return {};
    return {fmt::format("Let: {}.", check::shown(model, let.formula))};
}

Sentences about(const check::Constant& constant) {
    return {fmt::format("Constant: {}.", constant.text)};
}

}  // namespace

Sentences facts_of(const Analysis& analysis, const std::string& name, const Planned* planned) {
    const check::Inspected& checked = *analysis.checked;
    const check::Inspected::Named* const named = checked.find(name);
    if (named == nullptr) return {};
    const Model& model = checked.model;
    const Index i = named->index;
    const auto in = [i](const auto& all) { return i < all.size(); };
    using check::NameKind;
    switch (named->kind) {
        case NameKind::constant:
            for (const check::Constant& constant : model.constants)
                if (constant.name == name) return about(constant);
            return {};
        case NameKind::encoder: return in(model.encoders) ? about(model.encoders[i]) : Sentences{};
        case NameKind::input: return in(model.inputs) ? about(model, model.inputs[i]) : Sentences{};
        case NameKind::projection:
            return in(model.projections) ? about(model, model.projections[i]) : Sentences{};
        case NameKind::target:
            return in(model.targets) ? about(model, model.targets[i]) : Sentences{};
        case NameKind::predicate: return in(model.predicates) ? about(model, i) : Sentences{};
        case NameKind::let: return in(model.lets) ? about(model, model.lets[i]) : Sentences{};
        case NameKind::monitor:
            return in(model.monitors) ? about(model, model.monitors[i], checked.complete, planned)
                                      : Sentences{};
        case NameKind::unreadable: break;
    }
    return {};
}

}  // namespace etlc::lsp
