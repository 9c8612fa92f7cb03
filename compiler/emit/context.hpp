// What the parts of the header emitter share.
// Takes: the plan, the graph for comments, names. Gives: spellings of values, keys, numbers and
// comments. Keeps true: the same plan gives the same bytes on every machine; no path but the spec's
// file name is printed.
#pragma once

#include <string>
#include <string_view>

#include "emit/names.hpp"
#include "emit/spelling.hpp"
#include "emit/text/layout.hpp"
#include "plan/budget/budget.hpp"
#include "plan/budget/demand.hpp"
#include "plan/parameters.hpp"
#include "plan/plan.hpp"
#include "plan/program/dependents.hpp"
#include "plan/program/samples.hpp"
#include "plan/program/value_type.hpp"
#include "plan/recorder.hpp"

namespace etlc::emit {

/// The ends of what predicates can be, as code says them: "unseen_at_a().high". An end of more than
/// one of them is none's.
std::map<plan::Key, std::string> unseen_ends(const plan::Plan& plan, const Names& names);

struct Context {
    const plan::Plan& plan;
    const ir::Graph& graph;
    const check::Model& model;
    Names names;
    std::string spec_file;  ///< file name without folders
    std::string name_space;
    std::string targets_file;  ///< file name of the stored target sets, without folders
    const Spelling& spelling;
    /// Predicates are measured when a verdict first depends on them: one function does a step.
    bool on_demand;
    plan::Dependents dependents;
    std::vector<plan::Demand> demand = plan::demands(plan);  ///< per stream
    std::map<plan::Key, std::string> ends = unseen_ends(plan, names);
    plan::RecorderColumns recorded = plan::recorder_columns(plan);
    bool explains = plan::value_type(plan.values).sourced;
    plan::Samples sampled = plan::samples(plan);  ///< where it explains

    std::vector<plan::Parameter> parameters = {};  ///< of a retargetable class
    std::uint64_t shape = 0;                       ///< of such a class; 0 while it is found out
    /// All numbers of the spec lie in parameters that the monitor is given.
    bool retargetable() const { return model.retargetable; }
    /// Where one of these lies: "numbers_ + targets::goal", "numbers_[thresholds::near]".
    std::string parameter(plan::Parameter::Kind kind, check::Index index) const;
    std::string parameter(const check::Expr& number) const;
    /// Some target sets lie beside the header: the monitor has to be given them.
    bool stores_targets() const { return !plan.stored.empty(); }
    /// How the functions of a step are declared: where a call would cost as much as they do, part
    /// of the caller's loop.
    std::string_view step_qualifier() const;
    /// Measured on narrow rows, which leave it open within bounds; or on narrow rows that are the
    /// rows exactly.
    bool enclosed(check::Index distance) const;
    bool lossless(check::Index distance) const;
    std::string literal(plan::Value value) const;
    std::string literal(plan::Key key) const;
    /// The same of a predicate or bool as it is measured.
    std::string atom_literal(plan::Value value) const;
    /// The same of a bound: what predicates can be that are not seen yet.
    std::string bound(plan::Key key) const;
    /// The stream is found out when it is asked for: an atom of a Boolean monitor, or made of such.
    bool lazy(plan::Slot slot) const { return demand[slot].lazy; }
    /// A lazy combination that is found out once a step.
    bool keeps(plan::Slot slot) const { return demand[slot].keeps; }
    /// Target elements that a lazy stream may have to measure.
    std::uint64_t work(plan::Slot slot) const { return demand[slot].work; }
    /// Those that measure least first; in a robustness monitor as they are.
    std::vector<plan::Slot> by_work(std::vector<plan::Slot> slots) const;
    /// `now.at_a`, a local, a register or a constant: what stands for the stream in judge().
    std::string value(plan::Slot slot) const;
    /// The low or high key of a stream: "reach_.low", "etlmon::key_of(0.31f)".
    std::string low(plan::Slot slot) const;
    std::string high(plan::Slot slot) const;
    /// The steps since what begins with a monitor, or with the trace, began.
    const std::string& position(std::uint32_t begins_with) const;
    /// "dubins.etl:21: F at_a": where a formula stands and its words, or its text where the spec
    /// does not say it so.
    std::string place(plan::NodeId node) const;
    std::string place(source::Span span) const;
};

/// "position_ >= 2 && position_ <= 5", empty where the window is always open.
std::string open_condition(ir::Interval interval, std::string_view position);
/// "max_of(a, b, c)"; of one argument, that argument. Where some are lazy,
/// "max_of(max_of(a, b), c)".
std::string call(std::string_view function, const std::vector<std::string>& arguments,
                 bool lazy = false);

/// "positions evaluated again", "projected points", or both.
std::string what_takes_stack(const plan::Plan& plan);

// The parts of the header, in order.
void print_summary(Printer& out, const Context& context);
/// The figures that the head of the file and --emit report share.
void print_figures(Printer& out, const std::string& prefix, const plan::Plan& plan,
                   const std::string& targets_file);
void print_inputs_and_verdicts(Printer& out, const Context& context);
void print_constants(Printer& out, const Context& context);
void print_class(Printer& out, const Context& context);
void print_measure(Printer& out, const Context& context);
void print_atoms_on_demand(Printer& out, const Context& context);
void print_judge(Printer& out, const Context& context);
/// Opens the definition of a function that a step is made of: "Verdicts", "judge(...)".
void open_half(Printer& out, const Context& context, std::string_view result,
               std::string_view function);
/// Of a Boolean class: measure() and judge() in one, since what is measured depends on what is
/// judged.
void print_advance(Printer& out, const Context& context);
void print_streams(Printer& out, const Context& context);
void print_reading(Printer& out, const Context& context, std::uint32_t reading);
void print_tables(Printer& out, const Context& context);
void print_pending(Printer& out, const Context& context, std::uint32_t reading);
/// Of machines as tables: the lists of keys that say what the states are worth, as locals.
void print_machine_keys(Printer& out, const Context& context, std::uint32_t reading);
/// What the reading's value is assigned to: a Boolean monitor has declared it before it asks
/// whether to compute it.
std::string reading_declaration(const Context& context, std::uint32_t reading);
/// "reach_open || avoid_open"; empty where one of the monitors is sliding, or the class is not
/// Boolean: always.
std::string open_monitors(const Context& context, const std::vector<std::size_t>& monitors);

/// At the end of a step: where monitors that restart stand. A repeating one goes on with the next
/// step after a final verdict, which is a field of `verdicts`.
void print_progress(Printer& out, const Context& context, std::string_view verdicts);

/// The function of the runtime that decides the predicate: "is_at_most".
const char* comparison_name(const check::Predicate& predicate);
/// observe_P, set_threshold_P and what goes with them.
void print_adaptive_interface(Printer& out, const Context& context);
void print_adaptation_constants(Printer& out, const Context& context);

// The flight recorder, where the plan has one; nothing else prints anything then.
/// "etlmon::RecorderRow<6, 0, 4>"
std::string recorder_row(const Context& context);
void print_recorder_type(Printer& out, const Context& context);
void print_recorder_constants(Printer& out, const Context& context);
void print_recorder_interface(Printer& out, const Context& context);
/// What this step's row holds of a predicate whose distance or expression is `delta`, and of a
/// bool.
void print_recorded(Printer& out, const Context& context, check::Index predicate,
                    const std::string& delta);
void print_recorded_flag(Printer& out, const Context& context, check::Index input,
                         const std::string& flag);
/// At the end of a step, with the verdicts in `verdicts`; after print_progress, so that each alarm
/// of a repeating monitor is one that begins.
void print_record(Printer& out, const Context& context, const std::string& verdicts);

// Explanations, where values know their sample; nothing else prints anything then.
/// At the beginning of measure(): what the samples of this step have in common.
void print_rank(Printer& out, const Context& context);
/// At its end: the step is counted.
void print_step_measured(Printer& out, const Context& context);
/// The value of a predicate, with the sample that it has at this step: whose distance or
/// expression is `delta`. And of a bool.
std::string sourced(const Context& context, check::Index predicate, const std::string& value,
                    const std::string& delta);
std::string sourced_flag(const Context& context, check::Index input, const std::string& value,
                         const std::string& flag);
/// why_NAME(), and what they share.
void print_why(Printer& out, const Context& context);
void print_why_of(Printer& out, const Context& context);

/// A data member of the class: its declaration and how reset() sets it.
struct Member {
    std::string type;
    std::string name;
    std::string comment;
    std::string reset;    ///< a statement; empty: it outlives the episode
    std::string initial;  ///< empty: zeros, until the constructor or reset() sets it
    /// restart_NAME() of this monitor of the plan resets it too.
    std::uint32_t begins_with = plan::kNone;
};
std::vector<Member> members(const Context& context);
/// restart_NAME(), and what a repeating monitor has counted.
void print_restarts(Printer& out, const Context& context, const std::vector<Member>& all);
/// Those of readings and streams: the plan says what they are.
std::vector<Member> temporal_members(const Context& context);
/// "pending: b U[0, 23] c, ..., b U[0, 0] c": registers that are an array, from the first to the
/// last; `more`: there are others between them.
std::string comment_of_array(const Context& context, const plan::Member& first,
                             const plan::Member& last, bool more);
std::vector<Member> threshold_members(const Context& context);

// The parameters of a retargetable class; nothing else prints anything then.
/// What a monitor has to be given besides its state, in words.
std::string about_parameters(const plan::Plan& plan, bool is_calibrated);
/// Where they lie, and what a block of them must be.
void print_parameters(Printer& out, const Context& context);
/// Constructors, retarget() and what is asked about parameters.
void print_retarget_interface(Printer& out, const Context& context);
/// measure() of a monitor that has none yet.
void print_unknown_atoms(Printer& out, const Context& context);
void print_shadow(Printer& out, const Context& context);

// Telemetry of named predicates.
std::vector<Member> telemetry_members(const Context& context);
/// distance_P(), threshold_P(), nearest_P()
void print_telemetry(Printer& out, const Context& context);

// Telemetry of lets, where the plan has some; nothing else prints anything then.
std::vector<Member> let_members(const Context& context);
/// let_NAME() and robustness_NAME()
void print_let_interface(Printer& out, const Context& context);
/// At the end of a step: what they say of it.
void print_lets(Printer& out, const Context& context);

}  // namespace etlc::emit
