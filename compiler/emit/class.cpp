// Prints the class Monitor: types and constants, interface, state, and the two halves of a step.
#include <algorithm>

#include "check/model/fingerprint.hpp"
#include "emit/context.hpp"
#include "plan/program/value_type.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::emit {

namespace {

using check::Index;
using check::InputType;
using plan::StreamOp;

const char* element_type(InputType type) {
    if (type == InputType::i8) return "int8_t";
    return type == InputType::f16 ? "uint16_t" : "float";
}

/// Returns the members that keep samples: for `stale after` and `hold`.
std::vector<Member> sample_members(const Context& context) {
    std::vector<Member> result;
    for (const auto& [i, name] : context.names.stale_member) {
        const check::Input& input = context.model.inputs[i];
        result.push_back({fmt::format("etlmon::StaleAfter<{}, {}, {}>", element_type(input.type),
                                      input.dimension, input.stale_after),
                          name, fmt::format("last {}, and how often it came in a row", input.name),
                          name + ".reset();", ""});
    }
    for (const auto& [i, name] : context.names.hold_member) {
        const check::Input& input = context.model.inputs[i];
        const char* type = input.type == InputType::boolean ? "uint32_t" : "float";
        result.push_back(
            {fmt::format("etlmon::Hold<{}, {}, {}>", type, input.dimension, input.hold), name,
             fmt::format("last {} that was present", input.name), name + ".reset();", ""});
    }
    return result;
}

std::vector<Member> own_members(const Context& context) {
    const plan::Plan& plan = context.plan;
    std::vector<Member> result = sample_members(context);
    const std::vector<Member> earlier = earlier_members(context);
    result.insert(result.end(), earlier.begin(), earlier.end());
    for (const auto& [d, name] : context.names.search_member) {
        const check::Target& target = context.model.targets[context.model.distances[d].target];
        result.push_back({fmt::format("etlmon::Search<{}, {}>", target.rows, target.dimension),
                          name, "search state of " + context.model.distances[d].text,
                          name + ".reset();"});
    }
    const std::vector<Member> pasts = past_members(context);
    result.insert(result.end(), pasts.begin(), pasts.end());
    const std::vector<Member> telemetry = telemetry_members(context);
    result.insert(result.end(), telemetry.begin(), telemetry.end());
    const std::vector<Member> thresholds = threshold_members(context);
    result.insert(result.end(), thresholds.begin(), thresholds.end());
    const std::vector<Member> drifts = drift_members(context);
    result.insert(result.end(), drifts.begin(), drifts.end());
    for (const auto& [m, name] : context.names.verdict_member)
        result.push_back({context.spelling.verdict, name, "last verdict, for finish()",
                          fmt::format("{} = {}();", name, context.spelling.verdict), ""});
    const std::vector<Member> lets = let_members(context);
    result.insert(result.end(), lets.begin(), lets.end());
    if (context.on_demand)
        result.push_back({"Verdicts", "answers_", "last verdicts; final ones stay",
                          "answers_ = Verdicts();", ""});
    for (const auto& [m, name] : context.names.position_member)
        result.push_back({"uint32_t", name,
                          fmt::format("steps since {} began; saturates", plan.monitors[m].name),
                          name + " = 0;", "", static_cast<std::uint32_t>(m)});
    for (const auto& [m, name] : context.names.alarms_member) {
        const std::string& fulfilled = context.names.fulfilled_member.at(m);
        const std::string& monitor = plan.monitors[m].name;
        result.push_back({"uint32_t", name, fmt::format("alarms of {}; saturates", monitor),
                          name + " = 0;", ""});
        result.push_back({"uint32_t", fulfilled,
                          fmt::format("times that {} was fulfilled; saturates", monitor),
                          fulfilled + " = 0;", ""});
    }
    if (plan.counts_steps)
        result.push_back(
            {"uint32_t", "position_", "index of the step; saturates", "position_ = 0;", ""});
    if (plan.has_sliding)
        result.push_back({"uint32_t", "finishes_", "calls to finish()", "finishes_ = 0;", ""});
    result.push_back({"uint32_t", "incomplete_", "steps with something unknown; saturates",
                      "incomplete_ = 0;", ""});
    if (context.explains && !context.sampled.places.empty()) {
        result.push_back({"uint32_t", "measured_", "index of the step for measure(); saturates",
                          "measured_ = 0;", ""});
        result.push_back({fmt::format("etlmon::Deciding<{}>", plan.monitors.size()), "deciding_",
                          "values that decide the verdicts", "deciding_.reset();", ""});
    }
    if (plan.recorder)
        result.push_back({"Recorder", "recorder_", "recent steps, and incidents",
                          "recorder_.end_episode();", ""});
    return result;
}

/// Returns whether some stream reads positions that may lie outside the trace.
bool asks_what_exists(const plan::Plan& plan) {
    return plan.has_sliding ||
           std::any_of(plan.streams.begin(), plan.streams.end(), [](const plan::Stream& stream) {
               return stream.operand_lag > 0 && stream.op != StreamOp::delay &&
                      stream.op != StreamOp::combination;
           });
}

void print_exists(Printer& out, const Context& context) {
    print_doc(out, "Returns whether the trace contains the position `lag` steps ago.");
    out.open("bool exists(uint32_t lag) const noexcept {");
    out.line("return position_ >= lag{};", context.plan.has_sliding ? " && finishes_ <= lag" : "");
    out.close();
    out.line();
}

// ---- types and constants

void print_types(Printer& out, const Context& context) {
    const Spelling& words = context.spelling;
    const std::vector<Names::OfReading>& readings = context.names.readings;
    const bool has_tables = std::any_of(readings.begin(), readings.end(),
                                        [](const auto& names) { return !names.weak.empty(); });
    std::vector<std::pair<std::string, std::string>> types;
    types.emplace_back(
        fmt::format("using Value = {};", words.value),
        fmt::format("{}{}", words.value_meaning,
                    context.has_two_thresholds() ? ", or between two thresholds" : ""));
    if (!readings.empty())
        types.emplace_back(fmt::format("using Reading = {};", words.reading),
                           "a value, and its bounds over every continuation");
    if (has_tables)
        types.emplace_back(fmt::format("using Key = {};", words.key), "one end of a value");
    print_aligned(out, types, "///<");
    print_recorder_type(out, context);
    out.line();
    if (context.on_demand) return;
    print_doc(out, "The robustness of each predicate at one step.");
    out.open("struct Atoms {");
    for (const auto& [p, name] : context.names.predicate_atom)
        out.line("{} {};", words.value, name);
    for (const auto& [i, name] : context.names.flag_atom) out.line("{} {};", words.value, name);
    if (context.plan.recorder)
        out.line("{} row_;  // for the flight recorder", recorder_row(context));
    out.close("};");
    out.line();
}

void print_made_from(Printer& out, const Context& context) {
    if (context.retargetable()) return;  // the parameters say it
    const check::Fingerprint made_from = check::fingerprint(context.model);
    print_doc(out, "XXH64 of what the class was generated from; log them with the verdicts.");
    const auto hash = [](const char* name, std::uint64_t value) {
        return fmt::format("static constexpr uint64_t {} = 0x{:016x}u;", name, value);
    };
    print_aligned(out,
                  {{hash("kSpecHash", made_from.spec), context.spec_file},
                   {hash("kDataHash", made_from.data),
                    made_from.data == 0 ? "no target sets, no weights" : "target sets and weights"},
                   {hash("kThresholdsHash", made_from.thresholds),
                    made_from.thresholds == 0 ? "no named thresholds" : "initial thresholds"}},
                  "///<");
}

void print_class_constants(Printer& out, const Context& context) {
    const plan::Cost& cost = context.plan.cost;
    print_made_from(out, context);
    print_doc(out, "The cost of a monitor.");
    std::vector<std::pair<std::string, std::string>> sizes;
    sizes.emplace_back(fmt::format("static constexpr size_t kStateBytes = {};",
                                   context.stores_targets() || context.retargetable()
                                       ? fmt::format("etlmon::with_pointer({})", cost.state_bytes)
                                       : fmt::format("{}", cost.state_bytes)),
                       "sizeof(Monitor)");
    if (cost.stack_bytes > 0)
        sizes.emplace_back(
            fmt::format("static constexpr size_t kStackBytes = {};", cost.stack_bytes),
            "arrays on the stack of a step: " + plan::what_takes_stack(context.plan));
    sizes.emplace_back(fmt::format("static constexpr uint32_t kOperations = {};", cost.operations),
                       "min, max, compare in the worst case");
    sizes.emplace_back(
        fmt::format("static constexpr uint32_t kDistanceElements = {};", cost.distance_operations),
        context.names.stale_member.empty() ? "target elements compared in a step"
                                           : "elements of targets and last samples compared in a "
                                             "step");
    print_aligned(out, sizes, "///<");
    print_recorder_constants(out, context);
    out.line();
}

// ---- interface

void print_step_on_demand(Printer& out, const Context& context) {
    out.open(
        fmt::format("{}Verdicts step(const Inputs& in) noexcept {{", context.step_qualifier()));
    for (const Member& member : telemetry_members(context)) out.line(member.reset);
    out.line("return advance(in);");
    out.close();
}

void print_constructors(Printer& out, const Context& context) {
    if (context.retargetable()) return print_retarget_interface(out, context);
    if (!context.stores_targets()) {
        out.line("constexpr Monitor() noexcept { reset(); }");
        return out.line();
    }
    print_doc(out, fmt::format("Uses the targets of {}, which must outlive the monitor. While they "
                               "are not ready, every predicate on them is unknown at every step.",
                               context.targets_file));
    out.line("constexpr explicit Monitor(const Targets& etlmon_targets) noexcept");
    out.open("    : rows_(etlmon_targets.rows()) {");
    out.line("reset();");
    out.close();
    print_doc(out, "Uses the bytes of the file, and reads all of them once to check them.");
    out.line("Monitor(const uint8_t* etlmon_bytes, size_t etlmon_size) noexcept");
    out.line("    : Monitor(Targets(etlmon_bytes, etlmon_size)) {}");
    out.line();
    print_doc(out, "Returns whether the bytes are those that the class was generated with.");
    out.open("static bool valid(const uint8_t* bytes, size_t size) noexcept {");
    out.line("return Targets(bytes, size).ready();");
    out.close();
    print_doc(out, "Returns whether this monitor has its targets.");
    out.line("bool ready() const noexcept { return rows_ != nullptr; }");
    out.line();
}

void print_finish(Printer& out, const Context& context) {
    print_doc(out,
              "Called after the last step: each call reports one of the last positions of the "
              "sliding monitors, with their windows cut at the end of the trace. A sliding monitor "
              "that has reported its last position is undecided from then on; prefix monitors "
              "repeat their verdict.");
    out.open("Verdicts finish() noexcept {");
    print_wrapped(out, counted("finishes_"));
    out.line(context.on_demand ? "return advance(Inputs());" : "return judge(Atoms());");
    out.close();
    out.line();
}

/// The halves are public, so that a loop may run them at different times.
void declare_halves(Printer& out) {
    print_comment(out, "//",
                  "The two halves of a step: step(in) is judge(measure(in)). Neither changes a "
                  "member that the other uses, so one may interrupt the other. Call judge() once "
                  "with the result of each measure(), in the same order.");
    out.line();
    print_doc(
        out, "Measures every predicate at this step, and counts the step if a sample was missing.");
    out.line("Atoms measure(const Inputs& in) noexcept;");
    print_doc(out, "Advances every formula by one step.");
    out.line("Verdicts judge(const Atoms& now) noexcept;");
    out.line();
}

std::string reset_words(const Context& context) {
    std::string words = "Starts a new episode";
    if (!context.names.threshold_member.empty()) words += "; adaptive thresholds are kept";
    if (!context.names.drifts.empty()) words += "; drifts are kept";
    if (context.plan.recorder)
        words += "; incidents are kept, and those that wait for steps are completed";
    return words + ".";
}

void print_interface(Printer& out, const Context& context, const std::vector<Member>& all) {
    print_constructors(out, context);
    print_reference_interface(out, context);
    print_doc(out, reset_words(context));
    out.open("constexpr void reset() noexcept {");
    for (const Member& member : all)
        if (!member.reset.empty() && member.begins_with == plan::kNone) out.line(member.reset);
    for (const plan::Monitor& monitor : context.plan.monitors)
        if (monitor.restarts != check::Restarts::never) out.line("restart_{}();", monitor.name);
    out.close();
    out.line();
    print_restarts(out, context, all);
    print_doc(out, "Takes one time step.");
    if (context.on_demand)
        print_step_on_demand(out, context);
    else
        out.line("{}Verdicts step(const Inputs& in) noexcept {{ return judge(measure(in)); }}",
                 context.step_qualifier());
    out.line();
    if (context.plan.has_sliding) print_finish(out, context);
    if (!context.on_demand) declare_halves(out);
    if (!context.names.predicate_member.empty()) {
        print_doc(out,
                  fmt::format(
                      "Telemetry of the last step: the distance or expression of each predicate, "
                      "NaN if unknown{}, its threshold, and the row of the nearest target.{}",
                      context.on_demand ? " or not evaluated" : "",
                      context.has_two_thresholds()
                          ? " Of two thresholds, a number within inner_threshold_P() is true, one "
                            "beyond threshold_P() false, and one between them neither."
                          : ""));
        print_telemetry(out, context);
        out.line();
    }
    print_why(out, context);
    print_let_interface(out, context);
    print_adaptive_interface(out, context);
    print_drift_interface(out, context);
    print_doc(out, fmt::format("Returns the number of steps at which a predicate or bool input{} "
                               "was unknown{}; saturates.",
                               context.on_demand ? " that was evaluated" : "",
                               context.has_two_thresholds() ? ", its sample missing" : ""));
    out.line("uint32_t missing_steps() const noexcept { return incomplete_; }");
    out.line();
    print_recorder_interface(out, context);
}

// ---- what is private

void declare_advance(Printer& out) {
    print_doc(out,
              "Advances every formula by one step: min is \"and\", max is \"or\". A predicate is "
              "measured when a verdict that can still change first depends on it; min and max "
              "evaluate from left to right and stop at the operand that decides.");
    out.line("Verdicts advance(const Inputs& in) noexcept;");
    out.line();
}

/// Prints the ranges of predicates, used at steps that lack the sample.
void print_unseen(Printer& out, const Context& context) {
    if (context.retargetable()) {
        print_doc(out,
                  "The range of a predicate whose sample is missing: everything, since the "
                  "parameters may change.");
        out.open("static Value unseen() noexcept {");
        out.line("return Value{etlmon::kBottom, etlmon::kTop};");
        out.close();
        return out.line();
    }
    if (context.names.predicate_unseen.empty()) return;
    print_doc(out, "The range of a predicate's robustness, used where its sample is missing.");
    for (const auto& [p, name] : context.names.predicate_unseen)
        print_wrapped(out, fmt::format("static {} {}() noexcept {{ return {}; }}",
                                       context.spelling.atom, name,
                                       context.atom_literal(plan::unseen_range(
                                           context.model.predicates[p], context.plan.values))));
    out.line();
}

void print_state(Printer& out, const std::vector<Member>& all) {
    std::vector<std::pair<std::string, std::string>> lines;
    for (const Member& member : all)
        lines.emplace_back(fmt::format("{} {}{};", member.type, member.name,
                                       member.initial.empty() ? "{}" : " = " + member.initial),
                           member.comment);
    print_aligned(out, lines);
}

/// Returns whether the member consists of bytes in a class whose values are bytes.
bool is_bytes(const Context& context, const Member& member) {
    return member.type == "Value" || member.type == context.spelling.verdict ||
           member.type == "Verdicts" || member.type.find("PendingMachine") != std::string::npos;
}

}  // namespace

std::vector<Member> members(const Context& context) {
    std::vector<Member> all = temporal_members(context);
    const std::vector<Member> own = own_members(context);
    all.insert(all.end(), own.begin(), own.end());
    // Words come before bytes, so that only the end is padded.
    std::stable_partition(all.begin(), all.end(), [&](const Member& member) {
        return !context.spelling.bytes || !is_bytes(context, member);
    });
    if (context.stores_targets())
        all.insert(all.begin(), {"const float*", "rows_", "in " + context.targets_file, ""});
    if (context.retargetable())
        all.insert(all.begin(), {"const float*", "numbers_", "the parameters, or null", ""});
    return all;
}

void print_class(Printer& out, const Context& context) {
    const std::vector<Member> all = members(context);
    print_doc(
        out,
        "All monitors of the spec, stepped together. Instances are independent of each other.");
    out.open("class Monitor {");
    out.label("public:");
    print_types(out, context);
    print_class_constants(out, context);
    print_interface(out, context, all);
    out.label("private:");
    print_unseen(out, context);
    print_unknown_atoms(out, context);
    print_why_of(out, context);
    if (asks_what_exists(context.plan)) print_exists(out, context);
    if (context.on_demand) declare_advance(out);
    declare_parts(out, context);
    print_adaptation_constants(out, context);
    print_drift_constants(out, context);
    print_state(out, all);
    out.close("};");
    out.line(
        "static_assert(sizeof(Monitor) == Monitor::kStateBytes, \"the class has no padding\");");
    out.line();
    if (context.on_demand) {
        print_advance(out, context);
    } else {
        print_measure(out, context);
        out.line();
        print_judge(out, context);
    }
    out.line();
}

}  // namespace etlc::emit
