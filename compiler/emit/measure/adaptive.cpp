// Prints adaptive thresholds: their members, and the calls that change them.
#include "emit/context.hpp"
#include "plan/program/predicate_values.hpp"

namespace etlc::emit {

namespace {

std::string constant(const Context& context, check::Index p) {
    const check::Predicate& predicate = context.model.predicates[p];
    const etlmon::Adaptation by =
        plan::runtime_adaptation(*predicate.threshold.adaptation, predicate.upper_bound());
    return fmt::format("static constexpr etlmon::Adaptation {} = {{{}, {}, {}, {}, {}}};",
                       context.names.adaptation_constant.at(p), float_literal(by.lo),
                       float_literal(by.hi), float_literal(by.on_miss), float_literal(by.on_hit),
                       float_literal(by.grid));
}

}  // namespace

const char* comparison_name(const check::Predicate& predicate) {
    if (predicate.equality())
        return predicate.comparison == check::Comparison::equal ? "is_equal" : "is_unequal";
    if (predicate.upper_bound()) return predicate.strict() ? "is_below" : "is_at_most";
    return predicate.strict() ? "is_above" : "is_at_least";
}

std::vector<Member> threshold_members(const Context& context) {
    std::vector<Member> result;
    for (const auto& [p, name] : context.names.threshold_member)
        result.push_back({"float", name, "adaptive threshold; reset() keeps it", "",
                          float_literal(context.model.predicates[p].threshold.value)});
    return result;
}

void print_adaptive_interface(Printer& out, const Context& context) {
    if (context.names.threshold_member.empty()) return;
    print_doc(out,
              "Adaptive thresholds. Call observe_P when the label of a step arrives, at any later "
              "time, with the distance_P() of that step and whether P was true. If it was, the "
              "threshold of later steps changes: a miss widens it, a hit tightens it. A NaN "
              "distance changes nothing. reset() keeps the threshold. After a reboot, "
              "set_threshold_P restores a saved threshold_P(), and ignores NaN; "
              "set_threshold_P(initial_threshold_P()) returns to the calibrated one.");
    for (const auto& [p, member] : context.names.threshold_member) {
        const check::Predicate& predicate = context.model.predicates[p];
        out.open(fmt::format("void observe_{}(const float& distance, bool truth) noexcept {{",
                             predicate.name));
        print_wrapped(out, fmt::format("const etlmon::Truth found = etlmon::{}(distance, {});",
                                       comparison_name(predicate), member));
        print_wrapped(out, fmt::format("if (truth) {0} = etlmon::adapted({0}, found, {1});", member,
                                       context.names.adaptation_constant.at(p)));
        out.close();
        out.line("static constexpr float initial_threshold_{}() noexcept {{ return {}; }}",
                 predicate.name, float_literal(predicate.threshold.value));
        out.open(fmt::format("void set_threshold_{}(const float& threshold) noexcept {{",
                             predicate.name));
        print_wrapped(out, fmt::format("{0} = etlmon::restored(threshold, {0}, {1});", member,
                                       context.names.adaptation_constant.at(p)));
        out.close();
    }
    out.line();
}

void print_adaptation_constants(Printer& out, const Context& context) {
    if (context.names.threshold_member.empty()) return;
    print_doc(out,
              "Adaptive thresholds: lowest, highest, step on a miss, step on a hit, and the grid "
              "of all of them.");
    for (const auto& [p, member] : context.names.threshold_member)
        print_wrapped(out, constant(context, p));
    out.line();
}

}  // namespace etlc::emit
