// Prints measure(): from the samples of a step to the robustness of every predicate. A Boolean
// monitor evaluates samples and predicates when a verdict first depends on them
// (etlmon/temporal/demand.hpp).

#include <algorithm>
#include <cmath>

#include "emit/context.hpp"
#include "emit/measure/measurements.hpp"
#include "plan/program/dependents.hpp"
#include "plan/program/value_type.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"

namespace etlc::emit {

namespace {

using check::Expr;
using check::Index;

/// Returns the result of the kernel, for expressions.
std::string distance(const Context& context, Index d) {
    return context.names.distance_local.at(d) + (context.on_demand ? "()" : "");
}

std::string expression(const Context& context, const Expr& e) {
    const auto apply = [&](std::string_view function) {
        std::string text = expression(context, e.arguments[0]);
        if (e.arguments.size() == 1) return fmt::format("etlmon::{}({})", function, text);
        for (std::size_t i = 1; i < e.arguments.size(); ++i)
            text = fmt::format("etlmon::{}({}, {})", function, text,
                               expression(context, e.arguments[i]));
        return text;
    };
    switch (e.kind) {
        case Expr::Kind::number:
            return context.retargetable() ? context.parameter(e) : float_literal(e.number32);
        case Expr::Kind::scalar: return sample(context, e.index);
        case Expr::Kind::distance: return distance(context, e.index) + ".delta";
        case Expr::Kind::past: return context.names.past_local.at(e.index);
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

/// Returns the threshold of a predicate, or "inner, outer" of two. An infinite number is not the
/// result of a function, since some compilers assume that there is none.
std::string thresholds(const Context& context, Index p, bool named) {
    const check::Predicate& predicate = context.model.predicates[p];
    const auto one = [&](float value, const char* function) {
        return named && !std::isinf(value) ? fmt::format("{}_{}()", function, predicate.name)
                                           : float_literal(value);
    };
    const std::string outer = one(predicate.threshold.value, "threshold");
    if (!predicate.threshold.inner) return outer;
    if (context.retargetable())
        return fmt::format("{}, {}", context.threshold(p, true), context.threshold(p, false));
    return fmt::format("{}, {}", one(*predicate.threshold.inner, "inner_threshold"), outer);
}

/// Returns the runtime function that computes the robustness.
const char* robustness_name(const check::Predicate& predicate) {
    switch (predicate.comparison) {
        case check::Comparison::less_equal:
        case check::Comparison::less: return "at_most";
        case check::Comparison::equal: return "equal";
        case check::Comparison::not_equal: return "unequal";
        default: return "at_least";
    }
}

/// Prints the body of measure(). A distance that an expression or several predicates read gets a
/// local; others are stored in telemetry directly.
class MeasurePrinter {
public:
    MeasurePrinter(Printer& out, const Context& context)
        : out_(out), context_(context), uses_(plan::distance_uses(context.plan)) {}

    void print() {
        for (Index i : context_.plan.inputs) print_input(out_, context_, i);
        for (Index p : plan::built_points(context_.model, context_.plan.distances))
            print_point(out_, context_, p);
        for (Index d : context_.plan.distances)
            if (has_local(d)) print_shared(d);
        for (Index p : context_.plan.pasts) print_past(p);
        for (Index p : context_.plan.predicates) print_predicate(p);
    }

private:
    /// Returns the distances that get a local: read by an expression or several predicates, or
    /// known within bounds only.
    bool has_local(Index d) { return uses_[d] > 1 || context_.enclosed(d); }

    void print_shared(Index d) {
        const std::string& local = context_.names.distance_local.at(d);
        out_.gap();
        print_comment(out_, "//", context_.model.distances[d].text, 4);
        if (!context_.on_demand) {
            if (const auto call = measured_at_once(context_, d))
                return print_wrapped(out_,
                                     fmt::format("const etlmon::Measured {} = {};", local, *call));
            if (context_.enclosed(d))
                out_.line("etlmon::Enclosed {};", local);
            else
                out_.line("etlmon::Measured {} = etlmon::kUnmeasured;", local);
            print_distance(out_, context_, d, local);
            return;
        }
        out_.open(fmt::format("const etlmon::Lazy {}([&]() noexcept {{", local));
        if (const auto call = measured_at_once(context_, d)) {
            print_wrapped(out_, fmt::format("return {};", *call));
            return out_.close("});");
        }
        const bool enclosed = context_.enclosed(d);
        out_.line(enclosed ? "etlmon::Enclosed measured;"
                           : "etlmon::Measured measured = etlmon::kUnmeasured;");
        print_distance(out_, context_, d, "measured");
        out_.line(enclosed && !is_contrasted(d) ? "return measured.measured;" : "return measured;");
        out_.close("});");
    }

    /// Prints the step of a number that earlier steps have a part in, which every step has to take;
    /// finish() takes none.
    void print_past(Index p) {
        const check::Past& past = context_.model.pasts[p];
        const std::string call = fmt::format("{}.push({})", context_.names.past_member.at(p),
                                             expression(context_, past.expression));
        const bool may_finish = context_.on_demand && context_.plan.has_sliding;
        out_.gap();
        print_comment(out_, "//", context_.place(past.span), 4);
        print_wrapped(out_, fmt::format("const float {} = {}{}{};", context_.names.past_local.at(p),
                                        may_finish ? "finishes_ == 0 ? " : "", call,
                                        may_finish ? " : etlmon::kMissing" : ""));
    }

    void print_predicate(Index p) {
        const check::Predicate& predicate = context_.model.predicates[p];
        const auto telemetry = context_.names.predicate_member.find(p);
        const bool kept = telemetry != context_.names.predicate_member.end();
        const std::string& variable =
            kept ? telemetry->second : context_.names.predicate_local.at(p);
        const std::string& atom = context_.names.predicate_atom.at(p);
        const std::string threshold = thresholds(context_, p, kept);
        out_.gap();
        print_comment(out_, "//", context_.place(predicate.span), 4);
        const bool is_contrast = !plan::contrast_cuts(context_.plan, predicate).empty();
        if (context_.on_demand)
            out_.open(fmt::format("const etlmon::Lazy {}([&]() noexcept {{", atom));
        else if (is_contrast)
            out_.open("{");
        const std::string delta = predicate.plain_distance() ? plain(predicate, variable, kept)
                                  : is_contrast              ? contrast(p, variable)
                                                             : general(p, variable, kept);
        if (context_.on_demand) {
            const std::string range =
                context_.literal(plan::missing_value(predicate, context_.plan.values));
            out_.line(missed(fmt::format("etlmon::is_nan({})", delta)));
            print_recorded(out_, context_, p, delta);
            const std::string otherwise = range == "etlmon::kPerhaps" ? "" : ", " + range;
            print_wrapped(
                out_, fmt::format("return etlmon::{}({}, {}{});", comparison_name(predicate), delta,
                                  threshold, otherwise));
            out_.close("});");
            return;
        }
        const bool enclosed =
            predicate.plain_distance() && context_.enclosed(predicate.expression.index);
        const std::string known = enclosed
                                      ? context_.names.distance_local.at(predicate.expression.index)
                                  : is_contrast ? "apart"
                                                : delta;
        const std::string value = fmt::format("etlmon::{}({}, {}, {})", robustness_name(predicate),
                                              known, threshold, missing_value(p));
        print_wrapped(out_, fmt::format("now.{} = {};", atom, sourced(context_, p, value, delta)));
        out_.line(missed(fmt::format("etlmon::is_nan({})", delta)));
        print_recorded(out_, context_, p, delta);
        print_seen(out_, context_, p, delta);
        if (is_contrast) out_.close();
    }

    /// Returns the value of a predicate whose sample is missing.
    std::string missing_value(Index p) const {
        const check::Predicate& predicate = context_.model.predicates[p];
        if (!predicate.missing && context_.retargetable()) return "unseen()";
        if (!predicate.missing) return context_.names.predicate_unseen.at(p) + "()";
        return context_.atom_literal(plan::missing_value(predicate, context_.plan.values));
    }

    /// Prints AGG DIST(point, target), stored with its nearest row.
    std::string plain(const check::Predicate& predicate, const std::string& variable, bool kept) {
        const Index d = predicate.expression.index;
        if (has_local(d)) {
            std::string shared = context_.names.distance_local.at(d);
            if (context_.on_demand) shared += "()";
            if (context_.enclosed(d) && (!context_.on_demand || is_contrasted(d)))
                shared += ".measured";
            if (kept) out_.line("{} = {};", variable, shared);
            return (kept ? variable : shared) + ".delta";
        }
        if (const auto call = measured_at_once(context_, d)) {
            print_wrapped(out_, fmt::format("{}{} = {};", kept ? "" : "const etlmon::Measured ",
                                            variable, *call));
            return variable + ".delta";
        }
        // step() of a Boolean class has already set telemetry to unmeasured.
        if (!kept || !context_.on_demand)
            out_.line("{}{} = etlmon::kUnmeasured;", kept ? "" : "etlmon::Measured ", variable);
        print_distance(out_, context_, d, variable);
        return variable + ".delta";
    }

    /// Prints an EXPR. A missing operand is NaN, and so is the result.
    std::string general(Index p, const std::string& variable, bool kept) {
        const check::Predicate& predicate = context_.model.predicates[p];
        print_wrapped(out_, fmt::format("{}{} = {};", kept ? "" : "const float ", variable,
                                        expression(context_, predicate.expression)));
        print_nearest(p, [&](Index d) { return distance(context_, d) + ".nearest"; });
        return variable;
    }

    /// Prints the difference of two distances whose narrow rows give bounds only.
    std::string contrast(Index p, const std::string& variable) {
        const check::Predicate& predicate = context_.model.predicates[p];
        const auto both = *plan::contrast(predicate);
        const auto enclosed = [&](Index d) {
            const std::string known = distance(context_, d);
            return context_.enclosed(d) ? known : fmt::format("etlmon::exactly({})", known);
        };
        out_.line("etlmon::Enclosed left = {};", enclosed(both.first));
        out_.line("etlmon::Enclosed right = {};", enclosed(both.second));
        out_.line("etlmon::Enclosed apart = etlmon::difference(left, right);");
        print_comment(out_, "//", "too close to a threshold to decide: measured on float32 rows");
        print_wrapped(out_,
                      fmt::format("if (apart.doubtful({})) {{",
                                  cuts(plan::contrast_cuts(context_.plan, predicate), predicate)));
        out_.indent();
        if (context_.enclosed(both.first)) print_exact_distance(out_, context_, both.first, "left");
        if (context_.enclosed(both.second))
            print_exact_distance(out_, context_, both.second, "right");
        out_.line("apart = etlmon::difference(left, right);");
        out_.close();
        out_.line("{} = apart.measured.delta;", variable);
        print_nearest(p, [&](Index d) {
            return std::string(d == both.first ? "left" : "right") + ".measured.nearest";
        });
        return variable;
    }

    /// Stores the nearest row of each target set that an expression reads.
    template <class Row>
    void print_nearest(Index p, const Row& row) {
        for (const Index d : context_.model.predicates[p].distances())
            if (const auto nearest = context_.names.nearest.find({p, d});
                nearest != context_.names.nearest.end())
                out_.line("{} = {};", nearest->second.member, row(d));
    }

    /// Returns whether some contrast depends on the exact distance.
    bool is_contrasted(Index d) const {
        return std::any_of(context_.plan.predicates.begin(), context_.plan.predicates.end(),
                           [&](Index p) {
                               const auto both = plan::contrast(context_.model.predicates[p]);
                               return both && (both->first == d || both->second == d);
                           });
    }

    Printer& out_;
    const Context& context_;
    std::map<Index, int> uses_;
};

/// Without parameters nothing is known, and nothing of it later.
void print_unready(Printer& out, const Context& context) {
    if (context.names.earlier_member.empty() && context.names.past_member.empty())
        return print_wrapped(out, "if (!ready()) return unknown();");
    out.open("if (!ready()) {");
    for (const auto* members : {&context.names.earlier_member, &context.names.past_member})
        for (const auto& [index, name] : *members) out.line("{}.reset();", name);
    out.line("return unknown();");
    out.close();
}

}  // namespace

void print_measure(Printer& out, const Context& context) {
    const bool reads_inputs = !context.plan.inputs.empty();
    open_half(out, context, "Monitor::Atoms",
              fmt::format("measure({}const Inputs& in)", reads_inputs ? "" : "[[maybe_unused]] "));
    if (context.retargetable()) print_unready(out, context);
    out.line("Atoms now;");
    out.line("bool missing = false;");
    print_rank(out, context);
    MeasurePrinter(out, context).print();
    out.line();
    print_kept_points(out, context);
    print_step_measured(out, context);
    print_wrapped(out, "if (missing && incomplete_ != UINT32_MAX) ++incomplete_;");
    out.line("return now;");
    out.close();
}

void print_atoms_on_demand(Printer& out, const Context& context) {
    MeasurePrinter(out, context).print();
}

// Prints adaptive thresholds: their members, and the calls that change them.

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
