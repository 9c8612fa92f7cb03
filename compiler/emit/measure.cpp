// measure(): from the samples of a step to the robustness of every predicate. In a Boolean monitor the same samples and
// predicates, each found out when a verdict first depends on it (etlmon/demand.hpp).
#include "emit/context.hpp"
#include "plan/kernels.hpp"
#include "plan/literals.hpp"
#include "plan/narrow_targets.hpp"
#include "plan/stored.hpp"

namespace etlc::emit {

namespace {

using check::Expr;
using check::Index;
using check::InputType;

/// An input that is looked at on demand; one that is held is looked at on every step.
bool on_demand(const Context& context, Index i) {
    return context.boolean() && context.model.inputs[i].hold == 0;
}

std::string accepted(const check::Input& input) {
    if (!input.has_range) return fmt::format("etlmon::accept(in.{})", input.name);
    return fmt::format("etlmon::accept(in.{}, {}, {})", input.name, float_literal(input.range.low),
                       float_literal(input.range.high));
}

/// This step's sample: a number, NaN where it is missing; of an embedding a pointer, null where it is missing.
std::string sample(const Context& context, Index i) {
    const auto local = context.names.input_local.find(i);
    if (local == context.names.input_local.end()) return accepted(context.model.inputs[i]);
    return local->second + (on_demand(context, i) ? "()" : "");
}

/// The conditions under which all of some scalars are there: "!etlmon::is_nan(x) && !etlmon::is_nan(y)".
std::string all_present(const Context& context, const std::vector<Index>& scalars) {
    std::string text;
    for (Index i : scalars)
        text += fmt::format("{}!etlmon::is_nan({})", text.empty() ? "" : " && ", sample(context, i));
    return text;
}

std::string present(const check::Input& input) {
    return fmt::format("etlmon::present(in.{})", input.name);
}

std::string widening(const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    const std::string& buffer = context.names.input_buffer.at(i);
    if (input.type == InputType::f16)
        return fmt::format("etlmon::widen_f16(in.{}.data(), {}, {});", input.name, buffer, input.dimension);
    return fmt::format("etlmon::widen_i8(in.{}.data(), {}, {}, {});", input.name, float_literal(input.scale), buffer,
                       input.dimension);
}

bool is_widened(const check::Input& input) {
    return input.type == InputType::f16 || input.type == InputType::i8;
}

void print_widened(Printer& out, const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    const std::string& local = context.names.input_local.at(i);
    const std::string& buffer = context.names.input_buffer.at(i);
    out.line("float {}[{}];", buffer, input.dimension);
    out.line("const float* {} = nullptr;", local);
    out.open(fmt::format("if ({}) {{", present(input)));
    out.line(widening(context, i));
    out.line("{} = {};", local, buffer);
    out.close();
}

void print_flag(Printer& out, const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    const std::string& local = context.names.input_local.at(i);
    if (on_demand(context, i)) {
        out.open(fmt::format("const etlmon::Lazy {}([&]() noexcept {{", context.names.flag_atom.at(i)));
        out.line("missing |= !in.{}.present();", input.name);
        out.line("return etlmon::truth_of(in.{});", input.name);
        out.close("});");
        return;
    }
    if (input.hold == 0) {
        out.line("now.{} = etlmon::value_of(in.{});", context.names.flag_atom.at(i), input.name);
        out.line("missing |= !in.{}.present();", input.name);
        return;
    }
    const std::string& word = context.names.input_buffer.at(i);
    out.line("const uint32_t {} = in.{}.value();", word, input.name);
    out.line("const uint32_t* const {} = {}.take(in.{}.present() ? &{} : nullptr);", local,
             context.names.hold_member.at(i), input.name, word);
    if (context.boolean()) {
        out.open(fmt::format("const etlmon::Lazy {}([&]() noexcept {{", context.names.flag_atom.at(i)));
        out.line("missing |= {} == nullptr;", local);
        out.line("return etlmon::truth_of({0} != nullptr ? etlmon::Flag(*{0} != 0) : etlmon::Flag());", local);
        out.close("});");
        return;
    }
    out.line("now.{} = etlmon::value_of({} != nullptr ? etlmon::Flag(*{} != 0) : etlmon::Flag());",
             context.names.flag_atom.at(i), local, local);
    out.line("missing |= {} == nullptr;", local);
}

std::string data_of(const check::Input& input) {
    return fmt::format("in.{}.data()", input.name);
}

void print_scalar(Printer& out, const Context& context, Index i) {
    if (context.names.input_local.count(i) == 0) return;  // read in place
    const check::Input& input = context.model.inputs[i];
    const std::string& local = context.names.input_local.at(i);
    if (on_demand(context, i))
        out.line("const etlmon::Lazy {}([&]() noexcept {{ return {}; }});", local, accepted(input));
    else if (input.hold > 0)
        out.line("const float {} = {}.take({});", local, context.names.hold_member.at(i), accepted(input));
    else
        out.line("const float {} = {};", local, accepted(input));
}

void print_input_on_demand(Printer& out, const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    const std::string& local = context.names.input_local.at(i);
    if (!is_widened(input))
        return out.line("const etlmon::Lazy {}([&]() noexcept {{ return {} ? {} : nullptr; }});", local, present(input),
                        data_of(input));
    const std::string& buffer = context.names.input_buffer.at(i);
    out.line("float {}[{}];", buffer, input.dimension);
    out.open(fmt::format("const etlmon::Lazy {}([&]() noexcept -> const float* {{", local));
    out.line("if (!{}) return nullptr;", present(input));
    out.line(widening(context, i));
    out.line("return {};", buffer);
    out.close("});");
}

void print_input(Printer& out, const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    if (input.type == InputType::boolean) return print_flag(out, context, i);
    if (input.type == InputType::scalar) return print_scalar(out, context, i);
    if (on_demand(context, i)) return print_input_on_demand(out, context, i);
    const std::string& local = context.names.input_local.at(i);
    const bool held = input.hold > 0;
    if (is_widened(input))
        print_widened(out, context, i);
    else
        out.line("const float* {}{} = {} ? {} : nullptr;", held ? "" : "const ", local, present(input), data_of(input));
    if (held) out.line("{} = {}.take({});", local, context.names.hold_member.at(i), local);
}

std::string aggregation(const check::Distance& distance) {
    using enum check::Aggregation;
    switch (distance.aggregation) {
        case min: return "etlmon::Min";
        case max: return "etlmon::Max";
        case mean: return "etlmon::Mean";
        case kth: break;
    }
    return fmt::format("etlmon::Kth<{}>", distance.kth);
}

/// "etlmon::L2, etlmon::Min, 64, 384": what the kernels are told about a distance, beside its rows.
std::string kernel_parameters(const Context& context, Index d) {
    const check::Distance& distance = context.model.distances[d];
    const check::Target& target = context.model.targets[distance.target];
    return fmt::format("etlmon::{}, {}, {}, {}", plan::metric_name(distance), aggregation(distance), target.rows,
                       target.dimension);
}

std::string weights_argument(const Context& context, Index d) {
    const auto weights = context.names.weight_array.find(d);
    return weights == context.names.weight_array.end() ? "" : ", targets::" + weights->second;
}

/// The kernel's call on the point that `z` names, for float32 rows.
std::string wide_call(const Context& context, Index d, const std::string& z) {
    const auto search = context.names.search_member.find(d);
    if (search != context.names.search_member.end())
        return fmt::format("{}.nearest<etlmon::{}>({}, {} + targets::{})", search->second,
                           plan::metric_name(context.model.distances[d]), z, context.names.rows_member,
                           context.names.target_array.at(d));
    if (plan::stored_set(context.plan, d) != nullptr)
        return fmt::format("etlmon::measure_stored<{}>({}, {} + targets::{}{})", kernel_parameters(context, d), z,
                           context.names.rows_member, context.names.target_array.at(d), weights_argument(context, d));
    return fmt::format("etlmon::measure<{}, targets::{}>({}{})", kernel_parameters(context, d),
                       context.names.target_array.at(d), z, weights_argument(context, d));
}

/// The same for its narrow rows.
std::string narrow_call(const Context& context, const plan::NarrowSet& set, const std::string& z) {
    const std::string parameters = fmt::format("{}, targets::{}", kernel_parameters(context, set.distance),
                                               context.names.narrow_array.at(set.distance));
    const std::string weights = weights_argument(context, set.distance);
    if (set.storage == plan::Storage::f16) return fmt::format("etlmon::measure<{}>({}{})", parameters, z, weights);
    return fmt::format("etlmon::measure_scaled<{}>({}, {}{})", parameters, z, float_literal(set.scale), weights);
}

/// What its narrow rows say of the distance: the call that gives the interval.
std::string enclosing_call(const Context& context, const plan::NarrowSet& set, const std::string& z) {
    const check::Distance& distance = context.model.distances[set.distance];
    const std::string& rows = context.names.narrow_array.at(set.distance);
    if (plan::in_integers(set))
        return fmt::format("etlmon::measure_bytes<{}, targets::{}, targets::{}>({}, {}, {})",
                           kernel_parameters(context, set.distance), rows, context.names.sums_array.at(set.distance), z,
                           float_literal(set.scale), float_literal(set.moved));
    const std::string averaged = distance.aggregation == check::Aggregation::mean ? fmt::format(", {}", set.rows) : "";
    return fmt::format("etlmon::enclose<etlmon::{}>({}, {}, {}{})", plan::metric_name(distance),
                       narrow_call(context, set, z), float_literal(set.moved), set.dimension, averaged);
}

/// The thresholds that a distance is compared with, by name where they have one, and the other cuts as numbers.
std::string cuts(const Context& context, const plan::NarrowSet& set) {
    std::string text;
    for (const plan::Cut& cut : set.cuts) {
        std::string one = cut.low == cut.high
                              ? float_literal(cut.low)
                              : fmt::format("etlmon::Cut({}, {})", float_literal(cut.low), float_literal(cut.high));
        for (const auto& [p, name] : context.names.predicate_member) {
            const check::Predicate& predicate = context.model.predicates[p];
            const bool compared = predicate.plain_distance() && predicate.expression.index == set.distance;
            if (compared && predicate.threshold.value == cut.low && cut.low == cut.high)
                one = fmt::format("threshold_{}()", predicate.name);
        }
        text += (text.empty() ? "" : ", ") + one;
    }
    return text;
}

/// `into = ...`, the distance from the point that `z` names.
void print_measurement(Printer& out, const Context& context, Index d, const std::string& z, const std::string& into) {
    const plan::NarrowSet* set = plan::narrow_set(context.plan, d);
    if (!context.enclosed(d)) {
        const std::string call = set != nullptr ? narrow_call(context, *set, z) : wide_call(context, d, z);
        return print_wrapped(out, fmt::format("{} = {};", into, call));
    }
    print_wrapped(out, fmt::format("{} = {};", into, enclosing_call(context, *set, z)));
    print_wrapped(out, fmt::format("if ({}.doubtful({{{}}})) {{", into, cuts(context, *set)));
    out.indent();
    print_wrapped(out, fmt::format("{} = etlmon::exactly({});", into, wide_call(context, d, z)));
    out.close();
}

/// `into = measure(...)`, only where the inputs are there.
void print_distance(Printer& out, const Context& context, Index d, const std::string& into) {
    const check::Distance& distance = context.model.distances[d];
    const std::string ready = plan::stored_set(context.plan, d) == nullptr ? "" : "ready() && ";
    if (!distance.point_is_vector && !context.enclosed(d)) {
        const plan::NarrowSet* set = plan::narrow_set(context.plan, d);
        const std::string z = sample(context, distance.point[0]);
        const std::string call = set != nullptr ? narrow_call(context, *set, z) : wide_call(context, d, z);
        print_wrapped(out, fmt::format("if ({}{} != nullptr) {} = {};", ready, z, into, call));
        return;
    }
    std::string z = "point";
    const std::string present = distance.point_is_vector ? all_present(context, distance.point)
                                                         : sample(context, distance.point[0]) + " != nullptr";
    print_wrapped(out, fmt::format("if ({}{}) {{", ready, present));
    out.indent();
    if (distance.point_is_vector) {
        std::string elements;
        for (Index i : distance.point) elements += (elements.empty() ? "" : ", ") + sample(context, i);
        print_wrapped(out, fmt::format("const float point[{}] = {{{}}};", distance.point.size(), elements));
    } else {
        z = sample(context, distance.point[0]);
    }
    print_measurement(out, context, d, z, into);
    out.close();
}

std::string expression(const Context& context, const Expr& e) {
    const auto apply = [&](std::string_view function) {
        std::string text = expression(context, e.arguments[0]);
        if (e.arguments.size() == 1) return fmt::format("etlmon::{}({})", function, text);
        for (std::size_t i = 1; i < e.arguments.size(); ++i)
            text = fmt::format("etlmon::{}({}, {})", function, text, expression(context, e.arguments[i]));
        return text;
    };
    switch (e.kind) {
        case Expr::Kind::number: return float_literal(e.number32);
        case Expr::Kind::scalar: return sample(context, e.index);
        case Expr::Kind::distance:
            return context.names.distance_local.at(e.index) + (context.boolean() ? "()" : "") + ".delta";
        case Expr::Kind::negate: return apply("negate");
        case Expr::Kind::add: return apply("add");
        case Expr::Kind::subtract: return apply("subtract");
        case Expr::Kind::multiply: return apply("multiply");
        case Expr::Kind::divide: return apply("divide");
        case Expr::Kind::abs: return apply("absolute");
        case Expr::Kind::sqrt: return apply("root");
        case Expr::Kind::min: return apply("smaller");
        case Expr::Kind::max: return apply("greater");
    }
    return "";
}

/// Distances that an expression or more than one predicate reads get a local; the others go straight into telemetry.
std::map<Index, int> uses_of_distances(const Context& context) {
    std::map<Index, int> uses;
    const auto visit = [&](const auto& self, const Expr& e, int weight) -> void {
        if (e.kind == Expr::Kind::distance) uses[e.index] += weight;
        for (const Expr& argument : e.arguments) self(self, argument, 2);
    };
    for (Index p : context.plan.predicates) visit(visit, context.model.predicates[p].expression, 1);
    return uses;
}

class MeasurePrinter {
public:
    MeasurePrinter(Printer& out, const Context& context)
        : out_(out), context_(context), uses_(uses_of_distances(context)) {}

    void print() {
        for (Index i : context_.plan.inputs) print_input(out_, context_, i);
        for (Index d : context_.plan.distances)
            if (has_local(d)) print_shared(d);
        for (Index p : context_.plan.predicates) print_predicate(p);
    }

private:
    /// Distances that an expression or more than one predicate reads, and those known within bounds.
    bool has_local(Index d) { return uses_[d] > 1 || context_.enclosed(d); }

    void print_shared(Index d) {
        const std::string& local = context_.names.distance_local.at(d);
        out_.gap();
        out_.line("// {}", context_.model.distances[d].text);
        if (!context_.boolean()) {
            if (context_.enclosed(d))
                out_.line("etlmon::Enclosed {};", local);
            else
                out_.line("etlmon::Measured {} = etlmon::kUnmeasured;", local);
            print_distance(out_, context_, d, local);
            return;
        }
        out_.open(fmt::format("const etlmon::Lazy {}([&]() noexcept {{", local));
        const bool enclosed = context_.enclosed(d);
        out_.line(enclosed ? "etlmon::Enclosed measured;" : "etlmon::Measured measured = etlmon::kUnmeasured;");
        print_distance(out_, context_, d, "measured");
        out_.line(enclosed ? "return measured.measured;" : "return measured;");
        out_.close("});");
    }

    void print_predicate(Index p) {
        const check::Predicate& predicate = context_.model.predicates[p];
        const auto telemetry = context_.names.predicate_member.find(p);
        const bool kept = telemetry != context_.names.predicate_member.end();
        const std::string& variable = kept ? telemetry->second : context_.names.predicate_local.at(p);
        const std::string& atom = context_.names.predicate_atom.at(p);
        const std::string threshold =
            kept ? fmt::format("threshold_{}()", predicate.name) : float_literal(predicate.threshold.value);
        out_.gap();
        out_.line("// {}", context_.place(predicate.span));
        if (context_.boolean()) out_.open(fmt::format("const etlmon::Lazy {}([&]() noexcept {{", atom));
        const std::string delta =
            predicate.plain_distance() ? plain(predicate, variable, kept) : general(predicate, variable, kept);
        const std::string range = context_.literal(plan::unseen_range(predicate, context_.plan.values));
        if (context_.boolean()) {
            out_.line("missing |= etlmon::is_nan({});", delta);
            const std::string otherwise = range == "etlmon::kPerhaps" ? "" : ", " + range;
            out_.line("return etlmon::{}({}, {}{});", comparison_name(predicate), delta, threshold, otherwise);
            out_.close("});");
            return;
        }
        const bool enclosed = predicate.plain_distance() && context_.enclosed(predicate.expression.index);
        const std::string known = enclosed ? context_.names.distance_local.at(predicate.expression.index) : delta;
        print_wrapped(out_, fmt::format("now.{} = etlmon::{}({}, {}, {});", atom,
                                        predicate.upper_bound() ? "at_most" : "at_least", known, threshold, range));
        out_.line("missing |= etlmon::is_nan({});", delta);
    }

    /// AGG DIST(point, target): kept with its nearest row.
    std::string plain(const check::Predicate& predicate, const std::string& variable, bool kept) {
        const Index d = predicate.expression.index;
        if (has_local(d)) {
            std::string shared = context_.names.distance_local.at(d);
            if (context_.boolean())
                shared += "()";
            else if (context_.enclosed(d))
                shared += ".measured";
            if (kept) out_.line("{} = {};", variable, shared);
            return (kept ? variable : shared) + ".delta";
        }
        // What step() of a Boolean class keeps, it has called unmeasured.
        if (!kept || !context_.boolean())
            out_.line("{}{} = etlmon::kUnmeasured;", kept ? "" : "etlmon::Measured ", variable);
        print_distance(out_, context_, d, variable);
        return variable + ".delta";
    }

    /// EXPR: what is not there is NaN, and stays NaN in all arithmetic.
    std::string general(const check::Predicate& predicate, const std::string& variable, bool kept) {
        print_wrapped(out_, fmt::format("{}{} = {};", kept ? "" : "const float ", variable,
                                        expression(context_, predicate.expression)));
        return variable;
    }

    Printer& out_;
    const Context& context_;
    std::map<Index, int> uses_;
};

}  // namespace

void print_measure(Printer& out, const Context& context) {
    const bool reads_inputs = !context.plan.inputs.empty();
    out.line("/// The robustness of every predicate at this step; counts the step if something was missing.");
    out.open(fmt::format("{}Atoms measure({}const Inputs& in) noexcept {{", context.step_qualifier(),
                         reads_inputs ? "" : "[[maybe_unused]] "));
    out.line("Atoms now;");
    out.line("bool missing = false;");
    MeasurePrinter(out, context).print();
    out.line();
    out.line("if (missing && missing_steps_ != 0xffffffffu) ++missing_steps_;");
    out.line("return now;");
    out.close();
}

void print_atoms_on_demand(Printer& out, const Context& context) {
    MeasurePrinter(out, context).print();
}

}  // namespace etlc::emit
