// Why a verdict is what it is, in the class: what it remembers of samples, and why_NAME().
#include <fmt/ranges.h>

#include <algorithm>

#include "emit/context.hpp"
#include "source/escape.hpp"

namespace etlc::emit {

namespace {

using check::Index;
using Place = plan::Samples::Place;

bool is_used(const Context& context) {
    return context.explains && !context.sampled.places.empty();
}

/// What is remembered of a sample: no more than some predicate of the spec has.
const char* seen_type(const Context& context) {
    return context.sampled.adapts     ? "etlmon::SeenAdapting"
           : context.sampled.has_rows ? "etlmon::Seen"
                                      : "etlmon::SeenNumber";
}

bool remembers_rows(const Context& context) {
    return context.sampled.has_rows || context.sampled.adapts;
}

std::string shown(const Context& context, const Place& place) {
    return place.is_predicate ? context.model.predicates[place.index].shown()
                              : context.model.inputs[place.index].name;
}

std::string threshold(const Context& context, const Place& place) {
    if (!place.is_predicate) return "etlmon::kMissing";
    const check::Threshold& threshold = context.model.predicates[place.index].threshold;
    return threshold.adaptation ? "etlmon::kMissing" : float_literal(threshold.value);
}

}  // namespace

void print_samples_type(Printer& out, const Context& context) {
    if (!is_used(context)) return;
    const plan::Samples& samples = context.sampled;
    out.line();
    print_doc(out, fmt::format("What was measured in the last {}, and behind {} however long ago.",
                               diag::counted(samples.steps, "step"),
                               diag::counted(samples.followed, "value")));
    print_wrapped(out, fmt::format("using Samples = etlmon::Samples<{}, {}, {}, {}, {}>;",
                                   seen_type(context), samples.places.size(), samples.steps,
                                   samples.followed, context.plan.monitors.size()));
}

void print_seen_field(Printer& out, const Context& context) {
    if (is_used(context))
        out.line("{} seen_[{}];  // what was measured", seen_type(context),
                 context.sampled.places.size());
}

void print_seen(Printer& out, const Context& context, Index predicate, const std::string& delta) {
    if (!is_used(context)) return;
    const check::Predicate& of = context.model.predicates[predicate];
    constexpr std::string_view kDelta = ".delta";
    const std::string nearest =
        of.plain_distance() ? ", " + delta.substr(0, delta.size() - kDelta.size()) + ".nearest"
        : remembers_rows(context) ? ", etlmon::kNoRow"
                                  : "";
    const std::string threshold = !context.sampled.adapts ? ""
                                  : of.name.empty()       ? ", " + float_literal(of.threshold.value)
                                                    : fmt::format(", threshold_{}()", of.name);
    print_wrapped(
        out, fmt::format("now.seen_[{}] = {{{}{}{}}};", context.sampled.place_of(true, predicate),
                         delta, nearest, threshold));
}

void print_seen_flag(Printer& out, const Context& context, Index input, const std::string& flag) {
    if (!is_used(context)) return;
    print_wrapped(out, fmt::format("now.seen_[{}] = {{etlmon::measured({}){}{}}};",
                                   context.sampled.place_of(false, input), flag,
                                   remembers_rows(context) ? ", etlmon::kNoRow" : "",
                                   context.sampled.adapts ? ", etlmon::kMissing" : ""));
}

void print_sourced_atoms(Printer& out, const Context& context) {
    if (!is_used(context)) return;
    const std::vector<Place>& places = context.sampled.places;
    print_comment(out, "//",
                  "this step's samples; of equal values that of the earlier one is farther from 0");
    print_wrapped(out, fmt::format("const uint32_t rank = etlmon::Ranks<{}>::first(position);",
                                   places.size()));
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto& atoms =
            places[i].is_predicate ? context.names.predicate_atom : context.names.flag_atom;
        print_wrapped(out, fmt::format("const Value {} = etlmon::sourced(now.{}, rank{});",
                                       context.names.sourced_atoms[i], atoms.at(places[i].index),
                                       i == 0 ? "" : fmt::format(" - {}", i)));
    }
    out.line("samples.step(position, now.seen_);");
}

void print_answer(Printer& out, const Context& context, std::size_t m, const std::string& verdict) {
    if (!is_used(context)) return;
    const plan::Monitor& monitor = context.plan.monitors[m];
    const std::string reading = monitor.sliding ? context.value(monitor.stream)
                                                : context.names.readings[monitor.reading].local;
    print_wrapped(out, fmt::format("samples.answer({}, {}, {});", m, reading, verdict));
}

namespace {

/// Streams are computed before readings, and operands first.
std::vector<std::string> followed_streams(const Context& context) {
    const plan::Plan& plan = context.plan;
    std::vector<std::string> result;
    for (plan::Slot slot = 0; slot < plan.streams.size(); ++slot)
        for (const plan::Member& member : plan::members_of(plan.streams[slot]))
            if (plan::is_followed(member)) result.push_back(context.names.streams[slot].member);
    return result;
}

/// The members of a reading that are followed, as judge() assigns them.
std::vector<std::size_t> in_order(const plan::Reading& reading,
                                  const std::vector<plan::Member>& members) {
    std::vector<std::size_t> result;
    const auto add = [&](std::size_t i) {
        if (std::find(result.begin(), result.end(), i) == result.end()) result.push_back(i);
    };
    for (const plan::Assignment& assignment : reading.straight.assignments)
        if (assignment.target == plan::Term::Kind::reg) add(assignment.index);
    for (std::size_t i = 0; i < members.size(); ++i)
        if (plan::is_followed(members[i])) add(i);
    return result;
}

}  // namespace

void print_followed_streams(Printer& out, const Context& context) {
    if (!is_used(context)) return;
    const std::vector<std::string> values = followed_streams(context);
    for (std::size_t i = 0; i < values.size(); ++i)
        out.line("samples.follow({}, {}, rank);", i, values[i]);
}

void print_followed_readings(Printer& out, const Context& context) {
    if (!is_used(context)) return;
    std::size_t at = followed_streams(context).size();
    for (std::size_t r = 0; r < context.plan.readings.size(); ++r) {
        const plan::Reading& reading = context.plan.readings[r];
        const Names::OfReading& names = context.names.readings[r];
        const std::vector<plan::Member> members = plan::members_of(reading);
        for (const std::size_t i : in_order(reading, members))
            out.line("samples.follow({}, {}, rank);", at++, names.members[i]);
        // Of a machine what decides for good.
        if (plan::table_of(reading) != nullptr)
            out.line("samples.follow({}, {{{}.lower, {}.upper}}, rank);", at++, names.local,
                     names.local);
    }
}

void print_why(Printer& out, const Context& context) {
    if (!context.explains) return;
    print_doc(out,
              "The sample whose value decides the last verdict; none where that is unknown or "
              "undecided, or its value is that of no sample.");
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
    print_doc(out, "Of monitor m.");
    out.open("etlmon::Sample why(uint32_t m) const noexcept {");
    out.open("static constexpr etlmon::Place places[] = {");
    for (std::size_t i = 0; i < places.size(); ++i)
        out.line("{{{}, {}}}{}", source::json_string(shown(context, places[i])),
                 threshold(context, places[i]), i + 1 < places.size() ? "," : "");
    out.close("};");
    out.line("return samples.sample(m, places);");
    out.close();
    out.line();
}

}  // namespace etlc::emit
