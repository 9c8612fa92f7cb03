// The generated header, part by part in the order of the file.
#include <algorithm>
#include <set>

#include "emit/context.hpp"
#include "emit/emit.hpp"
#include "emit/standalone.hpp"
#include "plan/narrow_targets.hpp"
#include "plan/stored.hpp"

namespace etlc::emit {

namespace {

using check::Index;
using check::InputType;
using plan::StreamOp;

std::string file_name(const std::string& path) {
    return path.substr(path.find_last_of('/') + 1);
}

// ---- includes

bool any_stream(const plan::Plan& plan, std::initializer_list<StreamOp> ops) {
    return std::any_of(plan.streams.begin(), plan.streams.end(), [&](const plan::Stream& stream) {
        return std::find(ops.begin(), ops.end(), stream.op) != ops.end();
    });
}

/// What measures a distance.
const char* header_of(const Context& context, Index d) {
    if (plan::stored_set(context.plan, d) == nullptr) return "distance/kernel";
    return plan::searches(context.plan, d) ? "distance/search" : "distance/targets";
}

std::set<std::string> runtime_headers(const Context& context) {
    const plan::Plan& plan = context.plan;
    const bool boolean = context.boolean();
    std::set<std::string> headers{"scalars", "temporal/reading", "version"};
    headers.insert(boolean ? "temporal/demand" : "temporal/predicate");
    headers.insert(boolean ? "temporal/boolean_verdict" : "temporal/verdict");
    for (Index d : plan.distances) {
        headers.insert(header_of(context, d));
        if (context.enclosed(d)) headers.insert("distance/enclosed");
    }
    for (Index p : plan.predicates)
        if (!context.model.predicates[p].plain_distance()) headers.insert("temporal/expression");
    if (!context.names.threshold_member.empty()) headers.insert("temporal/adaptation");
    for (Index i : plan.inputs) {
        const check::Input& input = context.model.inputs[i];
        if (input.type == InputType::f16 || input.type == InputType::i8)
            headers.insert("distance/widen");
        if (input.hold > 0) headers.insert("temporal/hold");
    }
    if (any_stream(plan, {StreamOp::delay, StreamOp::shift}))
        headers.insert(boolean ? "temporal/boolean_window" : "temporal/delay");
    if (std::any_of(plan.monitors.begin(), plan.monitors.end(),
                    [](const plan::Monitor& m) { return m.shifted; }))
        headers.insert("temporal/shift");
    if (any_stream(plan, {StreamOp::window, StreamOp::window_since, StreamOp::window_until}))
        headers.insert(boolean ? "temporal/boolean_window" : "temporal/window");
    if (any_stream(plan, {StreamOp::widening})) headers.insert("temporal/widening");
    for (const Names::OfReading& reading : context.names.readings) {
        if (!reading.guards.empty()) headers.insert("temporal/machine");
        if (!reading.count.empty()) headers.insert("temporal/pending");
    }
    return headers;
}

void print_includes(Printer& out, const Context& context, const std::string& version,
                    bool standalone) {
    out.line("#pragma once");
    out.line();
    out.line("#include <stddef.h>");
    out.line("#include <stdint.h>");
    out.line();
    for (const std::string& header : runtime_headers(context))
        out.line("#include \"etlmon/{}.hpp\"", header);
    if (standalone && context.stores_targets()) {
        out.line("#if defined(ETLMON_MAPPED_TARGETS)  // on a POSIX host, to map {}",
                 context.targets_file);
        out.line("#include \"etlmon/hosted/mapped_targets.hpp\"");
        out.line("#endif");
    }
    const std::size_t dot = version.find('.');
    const std::string major = version.substr(0, dot);
    const std::string minor = version.substr(dot + 1, version.find('.', dot + 1) - dot - 1);
    out.line();
    out.line("#if ETLMON_VERSION_MAJOR != {} || ETLMON_VERSION_MINOR != {}", major, minor);
    out.line(
        "#error \"made by etlc {0}.{1}: run etlc again, or use the etlmon {0}.{1} that it was made "
        "for\"",
        major, minor);
    out.line("#endif");
    out.line();
}

// ---- the class

std::vector<Member> telemetry_members(const Context& context) {
    std::vector<Member> result;
    for (const auto& [p, name] : context.names.predicate_member) {
        const bool plain = context.model.predicates[p].plain_distance();
        result.push_back({plain ? "etlmon::Measured" : "float", name, "telemetry",
                          fmt::format("{} = etlmon::{};", name, plain ? "kUnmeasured" : "kMissing"),
                          ""});
    }
    return result;
}

std::vector<Member> own_members(const Context& context) {
    const plan::Plan& plan = context.plan;
    std::vector<Member> result;
    for (Index i : plan.inputs) {
        const auto held = context.names.hold_member.find(i);
        if (held == context.names.hold_member.end()) continue;
        const check::Input& input = context.model.inputs[i];
        const char* type = input.type == InputType::boolean ? "uint32_t" : "float";
        result.push_back(
            {fmt::format("etlmon::Hold<{}, {}, {}>", type, input.dimension, input.hold),
             held->second, fmt::format("the last {} that was there", input.name),
             held->second + ".reset();", ""});
    }
    for (const auto& [d, name] : context.names.search_member) {
        const check::Target& target = context.model.targets[context.model.distances[d].target];
        result.push_back({fmt::format("etlmon::Search<{}, {}>", target.rows, target.dimension),
                          name, "what it remembers of " + context.model.distances[d].text,
                          name + ".reset();"});
    }
    const std::vector<Member> telemetry = telemetry_members(context);
    result.insert(result.end(), telemetry.begin(), telemetry.end());
    const std::vector<Member> thresholds = threshold_members(context);
    result.insert(result.end(), thresholds.begin(), thresholds.end());
    for (const auto& [m, name] : context.names.verdict_member)
        result.push_back({"etlmon::Verdict", name, "the last one, for finish()",
                          name + " = etlmon::Verdict();", ""});
    if (context.boolean())
        result.push_back(
            {"Verdicts", "answers", "the last ones; final ones stay", "answers = Verdicts();", ""});
    if (plan.counts_steps)
        result.push_back(
            {"uint32_t", "position", "index of the step; saturates", "position = 0;", ""});
    if (plan.has_sliding)
        result.push_back({"uint32_t", "finishes", "calls of finish()", "finishes = 0;", ""});
    result.push_back({"uint32_t", "incomplete", "steps on which something was unknown; saturates",
                      "incomplete = 0;", ""});
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
            out.line("static constexpr float threshold_{}() noexcept {{ return {}; }}",
                     predicate.name, float_literal(predicate.threshold.value));
        else
            out.line("float threshold_{}() const noexcept {{ return {}; }}", predicate.name,
                     adaptive->second);
        if (plain)
            out.line("uint32_t nearest_{}() const noexcept {{ return {}.nearest; }}",
                     predicate.name, member);
    }
}

/// Some stream looks at positions that may lie before the trace, or after its end.
bool asks_what_exists(const plan::Plan& plan) {
    return plan.has_sliding ||
           std::any_of(plan.streams.begin(), plan.streams.end(), [](const plan::Stream& stream) {
               return stream.operand_lag > 0 && stream.op != StreamOp::delay &&
                      stream.op != StreamOp::combination;
           });
}

void print_exists(Printer& out, const Context& context) {
    out.line("/// Whether the trace has the position `lag` steps before this one.");
    out.line("bool exists(uint32_t lag) const noexcept {{ return position >= lag{}; }}",
             context.plan.has_sliding ? " && finishes <= lag" : "");
    out.line();
}

void print_atoms(Printer& out, const Context& context) {
    out.line("/// What this step says about each predicate.");
    out.open("struct Atoms {");
    for (const auto& [p, name] : context.names.predicate_atom) out.line("etlmon::Value {};", name);
    for (const auto& [i, name] : context.names.flag_atom) out.line("etlmon::Value {};", name);
    out.close("};");
    out.line();
}

void print_boolean_step(Printer& out, const Context& context) {
    out.open(
        fmt::format("{}Verdicts step(const Inputs& in) noexcept {{", context.step_qualifier()));
    for (const Member& member : telemetry_members(context)) out.line(member.reset);
    out.line("return advance(in);");
    out.close();
}

void print_constructors(Printer& out, const Context& context) {
    if (!context.stores_targets()) {
        out.line("Monitor() noexcept { reset(); }");
        return out.line();
    }
    out.line(
        "/// Over the targets of {}, which must stay where they are. Where they are not ready, "
        "every",
        context.targets_file);
    out.line("/// predicate on them is unknown at every step.");
    out.line(
        "explicit Monitor(const Targets& targets) noexcept : rows(targets.rows()) { reset(); }");
    out.line("/// The same from the bytes of the file, all of which are read once to check them.");
    out.line(
        "Monitor(const uint8_t* bytes, size_t size) noexcept : Monitor(Targets(bytes, size)) {}");
    out.line(
        "static bool valid(const uint8_t* bytes, size_t size) noexcept { return Targets(bytes, "
        "size).ready(); }");
    out.line("bool ready() const noexcept { return rows != nullptr; }  ///< has its targets");
    out.line();
}

void print_public_part(Printer& out, const Context& context, const std::vector<Member>& all) {
    const plan::Cost& cost = context.plan.cost;
    out.line("static constexpr size_t kStateBytes = {};  ///< sizeof(Monitor)",
             context.stores_targets() ? fmt::format("etlmon::with_pointer({})", cost.state_bytes)
                                      : fmt::format("{}", cost.state_bytes));
    if (cost.stack_bytes > 0)
        out.line(
            "static constexpr size_t kStackBytes = {};  ///< of a step, for positions evaluated "
            "anew",
            cost.stack_bytes);
    out.line(
        "static constexpr uint32_t kOperations = {};  ///< of the temporal part in the worst step: "
        "min, max, compare",
        cost.operations);
    out.line(
        "static constexpr uint32_t kDistanceElements = {};  ///< target elements measured in a "
        "step",
        cost.distance_operations);
    out.line();
    print_constructors(out, context);
    out.line("/// A new episode{}.", context.names.threshold_member.empty()
                                         ? ""
                                         : "; adaptive thresholds stay where they are");
    out.open("void reset() noexcept {");
    for (const Member& member : all)
        if (!member.reset.empty()) out.line(member.reset);
    out.close();
    out.line();
    out.line("/// One call, one time step.");
    if (context.boolean())
        print_boolean_step(out, context);
    else
        out.line("{}Verdicts step(const Inputs& in) noexcept {{ return judge(measure(in)); }}",
                 context.step_qualifier());
    out.line();
    if (context.plan.has_sliding) {
        out.line(
            "/// The trace has ended: each call reports one of the last positions of the sliding "
            "monitors, cut at the "
            "end;");
        out.line(
            "/// a monitor that has reported its last is undecided from then on. Prefix monitors "
            "repeat their "
            "verdict.");
        out.open("Verdicts finish() noexcept {");
        out.line("if (finishes != 0xffffffffu) ++finishes;");
        out.line(context.boolean() ? "return advance(Inputs());" : "return judge(Atoms());");
        out.close();
        out.line();
    }
    if (!context.names.predicate_member.empty()) {
        out.line(
            "/// Telemetry of the last step: a predicate's distance or expression, NaN where it "
            "was unknown{}",
            context.boolean() ? " or not asked for," : ", beside its");
        out.line("/// {}threshold, and the row of the nearest target.",
                 context.boolean() ? "beside its " : "");
        print_telemetry(out, context);
        out.line();
    }
    print_adaptive_interface(out, context);
    out.line("/// Steps on which some predicate or bool input {}was unknown; saturates.",
             context.boolean() ? "that was asked for " : "");
    out.line("uint32_t missing_steps() const noexcept { return incomplete; }");
}

/// measure() and judge(): public, and on disjoint members, for loops that do them at different
/// times.
void print_halves(Printer& out, const Context& context) {
    out.label("public:");
    out.line(
        "// A step in two halves: step(in) is judge(measure(in)). They share no member that either "
        "changes, so one "
        "may");
    out.line(
        "// interrupt the other; every measure() is followed by one judge() of what it gave, in "
        "the same order.");
    out.line();
    print_atoms(out, context);
    print_measure(out, context);
    out.line();
    print_judge(out, context);
    out.line();
    out.label("private:");
}

void print_class(Printer& out, const Context& context) {
    const std::vector<Member> all = members(context);
    out.line(
        "/// Every monitor of the spec, stepped together. Any number of instances; none of them "
        "shares anything.");
    out.open("class Monitor {");
    out.label("public:");
    print_public_part(out, context, all);
    out.line();
    out.label("private:");
    const bool boolean = context.boolean();
    out.line("using Value = etlmon::{};", boolean ? "Truth" : "Value");
    out.line("using Key = {};", boolean ? "bool" : "etlmon::Key");
    out.line("using Reading = etlmon::{};", boolean ? "BasicReading<Value>" : "Reading");
    out.line();
    if (asks_what_exists(context.plan)) print_exists(out, context);
    if (boolean) {
        print_advance(out, context);
        out.line();
    } else {
        print_halves(out, context);
    }
    print_adaptation_constants(out, context);
    std::vector<std::pair<std::string, std::string>> lines;
    for (const Member& member : all)
        lines.emplace_back(fmt::format("{} {}{};", member.type, member.name,
                                       member.initial.empty() ? "" : " = " + member.initial),
                           member.comment);
    print_aligned(out, lines);
    out.close("};");
    out.line(
        "static_assert(sizeof(Monitor) == Monitor::kStateBytes, \"no padding, no surprises\");");
    out.line();
}

/// Members of a Boolean class that are made of bytes.
bool is_bytes(const Member& member) {
    return member.type == "Value" || member.type == "Verdicts" ||
           member.type.find("PendingMachine") != std::string::npos;
}

}  // namespace

std::vector<Member> members(const Context& context) {
    std::vector<Member> all = temporal_members(context);
    const std::vector<Member> own = own_members(context);
    all.insert(all.end(), own.begin(), own.end());
    // Words before bytes: no padding but at the end.
    std::stable_partition(all.begin(), all.end(), [&](const Member& member) {
        return !context.boolean() || !is_bytes(member);
    });
    if (context.stores_targets())
        all.insert(all.begin(), {"const float*", "rows", "in " + context.targets_file, ""});
    return all;
}

std::string header(const plan::Plan& plan, const Options& options) {
    const check::Model& model = *plan.model;
    const bool boolean = plan.values == check::Values::boolean;
    const Context context{plan,
                          *plan.formulas,
                          model,
                          make_names(plan),
                          file_name(model.file.path()),
                          options.name_space.empty() ? model.name : options.name_space,
                          options.targets_file,
                          boolean ? truth_spelling() : Spelling(),
                          plan::dependents(plan)};
    Printer out;
    out.line("// Made by etlc {} from {}: change that, and run etlc again.", options.version,
             context.spec_file);
    print_summary(out, context);
    print_includes(out, context, options.version, !options.standalone.empty());
    out.line("namespace {} {{", context.name_space);
    out.line(
        "inline namespace ETLMON_BUILD {  // units compiled with other flags have a class of their "
        "own");
    out.line();
    print_inputs_and_verdicts(out, context);
    print_constants(out, context);
    print_tables(out, context);
    print_class(out, context);
    out.line("}  // namespace ETLMON_BUILD");
    out.line("}}  // namespace {}", context.name_space);
    return options.standalone.empty() ? out.take() : standalone(out.take(), options.standalone);
}

}  // namespace etlc::emit
