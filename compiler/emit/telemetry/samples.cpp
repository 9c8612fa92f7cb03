// Prints explanations: values that carry their sample, and why_NAME().
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

std::string threshold(const Context& context, const Place& place) {
    if (!place.is_predicate) return "etlmon::kMissing";
    const check::Threshold& threshold = context.model.predicates[place.index].threshold;
    return threshold.adaptation ? "etlmon::kMissing" : float_literal(threshold.value);
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
    out.line("// name, comparison, threshold, first code, number of rows that codes distinguish");
    out.open("static constexpr etlmon::Place places[] = {");
    for (std::size_t i = 0; i < places.size(); ++i)
        out.line("{{{}, Kind::{}, {}, {}, {}}}{}", source::json_string(shown(context, places[i])),
                 kind(context, places[i]), threshold(context, places[i]), places[i].first,
                 places[i].rows, i + 1 < places.size() ? "," : "");
    out.close("};");
    out.line("return etlmon::sample_of<{}>(deciding_[m], places);", context.sampled.codes);
    out.close();
    out.line();
}

}  // namespace etlc::emit
