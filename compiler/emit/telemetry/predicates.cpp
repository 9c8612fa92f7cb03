// Prints the telemetry of predicates: its members, and the functions that return it.
#include "emit/context.hpp"

namespace etlc::emit {

namespace {

using check::Index;

/// Prints threshold_P() of a predicate that is not adaptive.
void print_threshold(Printer& out, const Context& context, Index p) {
    const check::Predicate& predicate = context.model.predicates[p];
    if (!context.retargetable())
        return out.line("static constexpr float threshold_{}() noexcept {{ return {}; }}",
                        predicate.name, float_literal(predicate.threshold.value));
    out.open(fmt::format("float threshold_{}() const noexcept {{", predicate.name));
    out.line("return ready() ? {} : etlmon::kMissing;",
             context.parameter(plan::Parameter::Kind::threshold, p));
    out.close();
}

}  // namespace

std::vector<Member> telemetry_members(const Context& context) {
    std::vector<Member> result;
    for (const auto& [p, name] : context.names.predicate_member) {
        const bool plain = context.model.predicates[p].plain_distance();
        result.push_back({plain ? "etlmon::Measured" : "float", name,
                          "telemetry of " + context.model.predicates[p].name,
                          fmt::format("{} = etlmon::{};", name, plain ? "kUnmeasured" : "kMissing"),
                          ""});
    }
    for (const auto& [of, nearest] : context.names.nearest)
        result.push_back({"uint32_t", nearest.member,
                          fmt::format("nearest row by {}", context.model.distances[of.second].text),
                          nearest.member + " = 0;", ""});
    return result;
}

void print_telemetry(Printer& out, const Context& context) {
    for (const auto& [p, member] : context.names.predicate_member) {
        const check::Predicate& predicate = context.model.predicates[p];
        const bool plain = predicate.plain_distance();
        out.line("float distance_{}() const noexcept {{ return {}{}; }}", predicate.name, member,
                 plain ? ".delta" : "");
        const auto adaptive = context.names.threshold_member.find(p);
        if (adaptive == context.names.threshold_member.end())
            print_threshold(out, context, p);
        else
            out.line("float threshold_{}() const noexcept {{ return {}; }}", predicate.name,
                     adaptive->second);
        if (plain)
            out.line("uint32_t nearest_{}() const noexcept {{ return {}.nearest; }}",
                     predicate.name, member);
        for (check::Index d : predicate.distances())
            if (const auto nearest = context.names.nearest.find({p, d});
                nearest != context.names.nearest.end())
                out.line("uint32_t {}() const noexcept {{ return {}; }}", nearest->second.function,
                         nearest->second.member);
    }
}

}  // namespace etlc::emit
