// Prints explanations: values that carry their sample, and why_NAME().

#include <algorithm>
#include <cmath>

#include "emit/context.hpp"
#include "source/text.hpp"

namespace etlc::emit {

namespace {

using check::Index;
using Place = plan::Samples::Place;

bool is_used(const Context& context) {
    return context.explains && !context.sampled.places.empty();
}

std::string shown(const Context& context, const Place& place) {
    return place.is_predicate ? context.model.predicates[place.index].shown()
                              : context.model.inputs[place.index].name;
}

/// Returns a number in a constant expression.
std::string constant(float value) {
    if (!std::isinf(value)) return float_literal(value);
    return value < 0 ? "-etlmon::kInfinite" : "etlmon::kInfinite";
}

const char* kind(const Context& context, const Place& place) {
    if (!place.is_predicate) return "truth";
    switch (context.model.predicates[place.index].comparison) {
        case check::Comparison::less_equal:
        case check::Comparison::less: return "at_most";
        case check::Comparison::equal:
        case check::Comparison::not_equal: return "truth";
        default: return "at_least";
    }
}

/// Whether the place has two thresholds.
bool has_inner(const Context& context, const Place& place) {
    return place.is_predicate && context.model.predicates[place.index].threshold.inner.has_value();
}

std::string threshold(const Context& context, const Place& place) {
    if (!place.is_predicate) return "etlmon::kMissing";
    const check::Threshold& threshold = context.model.predicates[place.index].threshold;
    return threshold.adaptation ? "etlmon::kMissing" : constant(threshold.value);
}

}  // namespace

void print_rank(Printer& out, const Context& context) {
    if (!is_used(context)) return;
    print_comment(
        out, "//",
        "rank of this step's samples: of equal values, the earlier one is farther from 0");
    print_wrapped(out, fmt::format("const uint32_t rank = etlmon::Ranks<{}>::first(measured_);",
                                   context.sampled.codes));
}

void print_step_measured(Printer& out, const Context& context) {
    if (is_used(context)) print_wrapped(out, counted("measured_"));
}

std::string sourced(const Context& context, Index predicate, const std::string& value,
                    const std::string& delta) {
    if (!is_used(context)) return value;
    const Place& place = context.sampled.place_of(true, predicate);
    constexpr std::string_view kDelta = ".delta";
    const std::string row =
        place.rows == 0 ? ""
                        : fmt::format(", {}.nearest, {}",
                                      delta.substr(0, delta.size() - kDelta.size()), place.rows);
    return fmt::format("etlmon::sourced({}, rank - etlmon::code_of({}, {}{}))", value, place.first,
                       delta, row);
}

std::string sourced_flag(const Context& context, Index input, const std::string& value,
                         const std::string& flag) {
    if (!is_used(context)) return value;
    return fmt::format("etlmon::sourced({}, rank - etlmon::code_of({}, {}))", value,
                       context.sampled.place_of(false, input).first, flag);
}

void print_why(Printer& out, const Context& context) {
    if (!context.explains) return;
    print_doc(out,
              "Returns the sample that decides the last verdict; none if the verdict is unknown or "
              "undecided, or no sample has its value.");
    for (std::size_t m = 0; m < context.plan.monitors.size(); ++m)
        print_wrapped(
            out, fmt::format("etlmon::Sample why_{}() const noexcept {{ return {}; }}",
                             context.plan.monitors[m].name,
                             is_used(context) ? fmt::format("why({})", m) : "etlmon::Sample()"));
    out.line();
}

void print_why_of(Printer& out, const Context& context) {
    if (!is_used(context)) return;
    const std::vector<Place>& places = context.sampled.places;
    print_doc(out, "Returns the sample that decides the verdict of monitor m.");
    out.open("etlmon::Sample why(uint32_t m) const noexcept {");
    out.line("using Kind = etlmon::Place::Kind;");
    const bool of_two = std::any_of(places.begin(), places.end(),
                                    [&](const Place& place) { return has_inner(context, place); });
    out.line("// name, comparison, threshold, first code, number of rows that codes distinguish{}",
             of_two ? ", inner one of two thresholds" : "");
    out.open("static constexpr etlmon::Place places[] = {");
    for (std::size_t i = 0; i < places.size(); ++i)
        out.line("{{{}, Kind::{}, {}, {}, {}{}}}{}", source::json_string(shown(context, places[i])),
                 kind(context, places[i]), threshold(context, places[i]), places[i].first,
                 places[i].rows,
                 has_inner(context, places[i])
                     ? ", " + constant(*context.model.predicates[places[i].index].threshold.inner)
                     : "",
                 i + 1 < places.size() ? "," : "");
    out.close("};");
    const auto& monitors = context.plan.monitors;
    const bool shifts = std::any_of(monitors.begin(), monitors.end(),
                                    [](const plan::Monitor& m) { return m.shifted; });
    if (of_two && shifts) {
        std::string keys;
        for (const plan::Monitor& m : monitors)
            keys += fmt::format("{}{}", keys.empty() ? "" : ", ",
                                etlmon::key_of(m.inner_shift.value_or(m.shift)));
        print_with_comment(out, fmt::format("static constexpr etlmon::Key least[] = {{{}}};", keys),
                           "from which on each monitor is satisfied");
    }
    out.line("return etlmon::sample_of<{}>(deciding_[m], places{});", context.sampled.codes,
             of_two && shifts ? ", least[m]" : "");
    out.close();
    out.line();
}

// Prints the telemetry of lets: the verdict of each at the last step.

std::vector<Member> let_members(const Context& context) {
    std::vector<Member> result;
    const std::string verdict(context.spelling.verdict);
    for (std::size_t l = 0; l < context.plan.lets.size(); ++l) {
        const std::string& name = context.names.let_member[l];
        result.push_back(
            {verdict, name,
             "what " + context.model.lets[context.plan.lets[l].index].name + " said last",
             fmt::format("{} = {}();", name, verdict), ""});
    }
    return result;
}

void print_let_interface(Printer& out, const Context& context) {
    if (context.plan.lets.empty()) return;
    print_doc(out, fmt::format("The verdict of each let at the last step{}.",
                               context.on_demand ? "" : ", and its robustness"));
    for (std::size_t l = 0; l < context.plan.lets.size(); ++l) {
        const std::string& name = context.model.lets[context.plan.lets[l].index].name;
        const std::string& member = context.names.let_member[l];
        out.line("{} let_{}() const noexcept {{ return {}; }}", context.spelling.verdict, name,
                 member);
        if (!context.on_demand)
            out.line("float robustness_{}() const noexcept {{ return {}.robustness; }}", name,
                     member);
    }
    out.line();
}

namespace {

/// Returns the value of a let, without its sample.
std::string value_of(const Context& context, const plan::Let& let) {
    const std::string value = context.value(let.stream);
    return context.explains ? fmt::format("etlmon::unsourced({})", value) : value;
}

}  // namespace

/// Lets keep their last verdict during finish().
void print_lets(Printer& out, const Context& context) {
    const plan::Plan& plan = context.plan;
    if (plan.lets.empty()) return;
    out.gap();
    if (plan.has_sliding) out.open("if (finishes_ == 0) {");
    for (std::size_t l = 0; l < plan.lets.size(); ++l)
        print_with_comment(
            out,
            fmt::format("{} = etlmon::sliding_verdict({});", context.names.let_member[l],
                        value_of(context, plan.lets[l])),
            context.place(context.model.lets[plan.lets[l].index].span));
    if (plan.has_sliding) out.close();
}

// Prints the telemetry of predicates: its members, and the functions that return it.

namespace {

/// Prints threshold_P() of a predicate that is not adaptive, and inner_threshold_P().
void print_threshold(Printer& out, const Context& context, Index p) {
    const check::Predicate& predicate = context.model.predicates[p];
    for (const bool inner : {true, false}) {
        if (inner && !predicate.threshold.inner) continue;
        const std::string function =
            fmt::format("{}threshold_{}()", inner ? "inner_" : "", predicate.name);
        if (!context.retargetable()) {
            out.line("static constexpr float {} noexcept {{ return {}; }}", function,
                     constant(inner ? *predicate.threshold.inner : predicate.threshold.value));
            continue;
        }
        out.open(fmt::format("float {} const noexcept {{", function));
        out.line("return ready() ? {} : etlmon::kMissing;", context.threshold(p, inner));
        out.close();
    }
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
