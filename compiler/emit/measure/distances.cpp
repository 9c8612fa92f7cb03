// Prints the kernel calls in measure().
#include "emit/measure/measurements.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::emit {

using check::Index;

namespace {

std::string aggregation(const check::Distance& distance) {
    using check::Aggregation;
    switch (distance.aggregation) {
        case Aggregation::min: return "etlmon::Min";
        case Aggregation::max: return "etlmon::Max";
        case Aggregation::mean: return "etlmon::Mean";
        case Aggregation::kth: break;
    }
    return fmt::format("etlmon::Kth<{}>", distance.kth);
}

/// Returns the template arguments of a kernel but for its rows: "etlmon::L2, etlmon::Min, 64, 384".
std::string kernel_parameters(const Context& context, Index d) {
    const check::Distance& distance = context.model.distances[d];
    return fmt::format("etlmon::{}, {}, {}, {}", plan::metric_name(distance), aggregation(distance),
                       context.model.rows_of(d), context.model.dimension_of(d));
}

std::string weights_argument(const Context& context, Index d) {
    const auto weights = context.names.weight_array.find(d);
    if (weights == context.names.weight_array.end()) return "";
    if (context.retargetable()) return ", " + context.parameter(plan::Parameter::Kind::weights, d);
    return ", targets::" + weights->second;
}

/// Returns the kernel call on the point named `z`, for float32 rows.
std::string wide_call(const Context& context, Index d, const std::string& z) {
    if (context.retargetable())
        return fmt::format("etlmon::measure_rows<{}>({}, {}{})", kernel_parameters(context, d), z,
                           context.parameter(plan::Parameter::Kind::rows, d),
                           weights_argument(context, d));
    const auto search = context.names.search_member.find(d);
    if (search != context.names.search_member.end())
        return fmt::format("{}.nearest<etlmon::{}>({}, rows_ + targets::{})", search->second,
                           plan::metric_name(context.model.distances[d]), z,
                           context.names.target_array.at(d));
    if (plan::stored_set(context.plan, d) != nullptr)
        return fmt::format("etlmon::measure_stored<{}>({}, rows_ + targets::{}{})",
                           kernel_parameters(context, d), z, context.names.target_array.at(d),
                           weights_argument(context, d));
    return fmt::format("etlmon::measure<{}, targets::{}>({}{})", kernel_parameters(context, d),
                       context.names.target_array.at(d), z, weights_argument(context, d));
}

/// Returns the kernel call for narrow rows.
std::string narrow_call(const Context& context, const plan::NarrowSet& set, const std::string& z) {
    const std::string parameters =
        fmt::format("{}, targets::{}", kernel_parameters(context, set.distance),
                    context.names.narrow_array.at(set.distance));
    const std::string weights = weights_argument(context, set.distance);
    if (set.storage == plan::Storage::f16)
        return fmt::format("etlmon::measure<{}>({}{})", parameters, z, weights);
    return fmt::format("etlmon::measure_scaled<{}>({}, {}{})", parameters, z,
                       float_literal(set.scale), weights);
}

/// Returns the kernel call on the rows of a distance that has only one kind of them.
std::string only_call(const Context& context, Index d, const std::string& z) {
    const plan::NarrowSet* set = plan::narrow_set(context.plan, d);
    return set != nullptr ? narrow_call(context, *set, z) : wide_call(context, d, z);
}

/// Returns the call that encloses the distance, from its narrow rows.
std::string enclosing_call(const Context& context, const plan::NarrowSet& set,
                           const std::string& z) {
    const check::Distance& distance = context.model.distances[set.distance];
    const std::string averaged =
        distance.aggregation == check::Aggregation::mean ? fmt::format(", {}", set.rows) : "";
    return fmt::format("etlmon::enclose<etlmon::{}>({}, {}, {}{})", plan::metric_name(distance),
                       narrow_call(context, set, z), float_literal(set.moved), set.dimension,
                       averaged);
}

/// Returns the condition that all scalars are present: "!etlmon::is_nan(x) && !etlmon::is_nan(y)".
std::string all_present(const Context& context, const std::vector<Index>& scalars) {
    std::string text;
    for (Index i : scalars)
        text +=
            fmt::format("{}!etlmon::is_nan({})", text.empty() ? "" : " && ", sample(context, i));
    return text;
}

/// Prints `into = ...`, the distance from the point named `z`.
void print_measurement(Printer& out, const Context& context, Index d, const std::string& z,
                       const std::string& into) {
    if (!context.enclosed(d))
        return print_wrapped(out, fmt::format("{} = {};", into, only_call(context, d, z)));
    const plan::NarrowSet& set = *plan::narrow_set(context.plan, d);
    print_wrapped(out, fmt::format("{} = {};", into, enclosing_call(context, set, z)));
    if (set.cuts.empty()) return;  // used by contrasts only
    print_comment(out, "//", "too close to a threshold to decide: measured on float32 rows");
    print_wrapped(out, fmt::format("if ({}.doubtful({})) {{", into, cuts(context, set)));
    out.indent();
    print_wrapped(out, fmt::format("{} = etlmon::exactly({});", into, wide_call(context, d, z)));
    out.close();
}

}  // namespace

std::optional<std::string> measured_at_once(const Context& context, Index d) {
    const check::Distance& distance = context.model.distances[d];
    const check::Point& point = context.model.point_of(d);
    if (distance.is_between_points())
        return fmt::format("etlmon::measure_between<etlmon::{}, {}>({}, {}{})",
                           plan::metric_name(distance), point.dimension,
                           elements_of(context, distance.point),
                           elements_of(context, distance.other), weights_argument(context, d));
    if (point.is_vector() && plan::checks_point(context.plan, d))
        return wide_call(context, d, '{' + scalars_of(context, point) + '}');
    const Index embedding = point.inputs[0];
    if (point.kind != check::Point::Kind::embedding ||
        context.names.input_local.count(embedding) != 0)
        return std::nullopt;
    const auto direction = context.names.direction_local.find(embedding);
    const bool shared =
        direction != context.names.direction_local.end() && !plan::rows_as_given(distance);
    return wide_call(context, d, shared ? direction->second : sample(context, embedding));
}

namespace {

/// Prints the statement that `measure` prints for the name of the point, under the condition that
/// the inputs are present.
template <class Measure>
void print_where_there(Printer& out, const Context& context, Index d, const Measure& measure) {
    const Index index = context.model.distances[d].point;
    const check::Point& point = context.model.points[index];
    const std::string ready = plan::stored_set(context.plan, d) == nullptr ? "" : "ready() && ";
    std::string z = "point";
    const std::string present = point.is_vector() ? all_present(context, point.inputs)
                                                  : elements_of(context, index) + " != nullptr";
    print_wrapped(out, fmt::format("if ({}{}) {{", ready, present));
    out.indent();
    if (point.is_vector()) {
        const std::string elements = scalars_of(context, point);
        print_wrapped(out,
                      fmt::format("const float point[{}] = {{{}}};", point.dimension, elements));
    } else {
        z = elements_of(context, index);
    }
    measure(z);
    out.close();
}

}  // namespace

void print_distance(Printer& out, const Context& context, Index d, const std::string& into) {
    const Index point = context.model.distances[d].point;
    if (!context.model.points[point].is_vector() && !context.enclosed(d)) {
        const std::string ready = plan::stored_set(context.plan, d) == nullptr ? "" : "ready() && ";
        const std::string z = elements_of(context, point);
        print_wrapped(out, fmt::format("if ({}{} != nullptr) {} = {};", ready, z, into,
                                       only_call(context, d, z)));
        return;
    }
    print_where_there(out, context, d,
                      [&](const std::string& z) { print_measurement(out, context, d, z, into); });
}

void print_exact_distance(Printer& out, const Context& context, Index d, const std::string& into) {
    print_where_there(out, context, d, [&](const std::string& z) {
        print_wrapped(out,
                      fmt::format("{} = etlmon::exactly({});", into, wide_call(context, d, z)));
    });
}

namespace {

/// Names a number if it is a threshold of the predicate.
void name_threshold(const check::Predicate& of, float at, std::string& text) {
    if (of.threshold.value == at) text = fmt::format("threshold_{}()", of.name);
    if (of.threshold.inner == at) text = fmt::format("inner_threshold_{}()", of.name);
}

template <class Name>
std::string cut_list(const std::vector<plan::Cut>& cuts, const Name& name) {
    std::string text;
    for (const plan::Cut& cut : cuts) {
        std::string one = cut.low == cut.high
                              ? float_literal(cut.low)
                              : fmt::format("etlmon::Cut({}, {})", float_literal(cut.low),
                                            float_literal(cut.high));
        if (cut.low == cut.high) name(cut.low, one);
        text += (text.empty() ? "" : ", ") + one;
    }
    return "{" + text + "}";
}

}  // namespace

std::string cuts(const Context& context, const plan::NarrowSet& set) {
    return cut_list(set.cuts, [&](float at, std::string& text) {
        for (const auto& [p, name] : context.names.predicate_member) {
            const check::Predicate& predicate = context.model.predicates[p];
            const bool compared =
                predicate.plain_distance() && predicate.expression.index == set.distance;
            if (compared) name_threshold(predicate, at, text);
        }
    });
}

std::string cuts(const std::vector<plan::Cut>& cuts, const check::Predicate& of) {
    return cut_list(cuts, [&](float at, std::string& text) { name_threshold(of, at, text); });
}

}  // namespace etlc::emit
