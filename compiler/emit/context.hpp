// The context that the parts of the header emitter share: the plan, its names, and the spelling of
// values, keys, numbers and comments. The same plan gives the same bytes on every machine, and no
// path but the spec's file name is printed.
#pragma once

#include <string>
#include <string_view>

#include "emit/names.hpp"
#include "emit/text/layout.hpp"
#include "plan/budget/budget.hpp"
#include "plan/parameters.hpp"
#include "plan/plan.hpp"
#include "plan/program/dependents.hpp"
#include "plan/program/sample_codes.hpp"
#include "plan/program/value_type.hpp"
#include "plan/recorder_plan.hpp"

namespace etlc::emit {

/// Returns code for the ends of the ranges of predicates: "unseen_at_a().high". An end that several
/// predicates have maps to the empty string.
std::map<plan::Key, std::string> unseen_ends(const plan::Plan& plan, const Names& names);

/// The functions that judge() calls for some monitors each, since compilers take more than linear
/// time for long functions. Streams and readings of none of them are computed by judge() itself.
struct Parts {
    std::uint32_t count = 0;
    std::vector<std::uint32_t> of_stream, of_reading, of_monitor;  ///< kNone: judge() itself
    std::vector<plan::Slot> shared_streams;  ///< computed by judge() itself, and not members
    std::vector<std::uint32_t> shared_readings;
    bool share() const { return !shared_streams.empty() || !shared_readings.empty(); }
};
Parts parts_of(const plan::Plan& plan, const plan::Dependents& dependents, bool on_demand);

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
    Parts parts = parts_of(plan, dependents, on_demand);
    std::vector<plan::Demand> demand = plan::demands(plan);  ///< per stream
    std::map<plan::Key, std::string> ends = unseen_ends(plan, names);
    plan::RecorderColumns recorded = plan::recorder_columns(plan);
    bool explains = plan::value_type(plan.values).sourced;
    plan::Samples sampled = plan::samples(plan);  ///< only of a class that explains

    std::vector<plan::Parameter> parameters = {};  ///< of a retargetable class
    std::uint64_t shape = 0;                       ///< of such a class; 0 while the shape is
                                                   ///< computed
    /// Whether sketches of reference frames are printed. They are no part of the shape.
    bool with_references = true;
    /// Returns whether all numbers of the spec are parameters of the monitor.
    bool retargetable() const { return model.retargetable; }
    /// Whether some predicate has two thresholds.
    bool has_two_thresholds() const;
    /// Returns code for a parameter: "numbers_ + targets::goal", "numbers_[thresholds::near]".
    /// Returns a threshold among the parameters: the only one, or the inner or outer one of two.
    std::string threshold(check::Index predicate, bool inner) const;
    std::string parameter(plan::Parameter::Kind kind, check::Index index) const;
    std::string parameter(const check::Expr& number) const;
    /// Returns whether some target sets are stored outside the header.
    bool stores_targets() const { return !plan.stored.empty(); }
    /// Returns the qualifier of the functions of a step: inlined where a call would cost as much as
    /// the function.
    std::string_view step_qualifier() const;
    /// Returns whether narrow rows give bounds on the distance, or give it exactly.
    bool enclosed(check::Index distance) const;
    bool lossless(check::Index distance) const;
    std::string literal(plan::Value value) const;
    std::string literal(plan::Key key) const;
    /// Returns a literal of the type of atoms.
    std::string atom_literal(plan::Value value) const;
    /// Returns code for a bound, by the name of a predicate's range where it is an end of one.
    std::string bound(plan::Key key) const;
    /// Returns whether the stream is evaluated on demand: an atom of a Boolean monitor, or a
    /// combination of such.
    bool lazy(plan::Slot slot) const { return demand[slot].lazy; }
    /// Returns whether the stream is a lazy combination that is evaluated at most once a step.
    bool keeps(plan::Slot slot) const { return demand[slot].keeps; }
    /// Returns the number of target elements that a lazy stream may have to measure.
    std::uint64_t work(plan::Slot slot) const { return demand[slot].work; }
    /// Returns the slots sorted by the work of measuring them; a robustness monitor keeps their
    /// order.
    std::vector<plan::Slot> by_work(std::vector<plan::Slot> slots) const;
    /// Returns code for the stream in judge(): `now.at_a`, a local, a register or a constant.
    std::string value(plan::Slot slot) const;
    std::string local(plan::Slot slot) const;
    /// Returns code for the reading in judge().
    std::string reading(std::uint32_t index) const;
    /// Returns code for the low or high key of a stream: "reach_.low", "etlmon::key_of(0.31f)".
    std::string low(plan::Slot slot) const;
    std::string high(plan::Slot slot) const;
    /// Returns code for the number of steps since the monitor, or the trace, began.
    const std::string& position(std::uint32_t begins_with) const;
    /// Returns the place and source text of a formula: "dubins.etl:21: F at_a"; also its normalised
    /// text where that differs by more than blanks.
    std::string place(plan::NodeId node) const;
    std::string place(source::Span span) const;
};

/// Returns the condition "position_ >= 2 && position_ <= 5", empty if the window is always open.
std::string open_condition(ir::Interval interval, std::string_view position);
/// Returns the call "max_of(a, b, c)", or the only argument. If some are lazy, "max_of(max_of(a,
/// b), c)".
std::string call(std::string_view function, const std::vector<std::string>& arguments,
                 bool lazy = false);

// The parts of the header, in order.
void print_summary(Printer& out, const Context& context);
/// Prints the figures that the head of the file and --emit report share.
void print_figures(Printer& out, const std::string& prefix, const plan::Plan& plan,
                   const std::string& targets_file);
void print_inputs_and_verdicts(Printer& out, const Context& context);
void print_constants(Printer& out, const Context& context);
void print_class(Printer& out, const Context& context);
void print_measure(Printer& out, const Context& context);
void print_atoms_on_demand(Printer& out, const Context& context);
void print_judge(Printer& out, const Context& context);
/// Declares the functions that judge() calls.
void declare_parts(Printer& out, const Context& context);
/// Opens the definition of one of the functions of a step: "Verdicts", "judge(...)".
void open_half(Printer& out, const Context& context, std::string_view result,
               std::string_view function);
/// Prints measure() and judge() of a Boolean class as one function, since the verdicts decide what
/// is measured.
void print_advance(Printer& out, const Context& context);
void print_streams(Printer& out, const Context& context, std::uint32_t part = plan::kNone);
void print_reading(Printer& out, const Context& context, std::uint32_t reading);
void print_tables(Printer& out, const Context& context);
void print_pending(Printer& out, const Context& context, std::uint32_t reading);
/// Prints the keys of a table machine, from which its states are read, as local arrays.
void print_machine_keys(Printer& out, const Context& context, std::uint32_t reading);
/// Returns the left side of the reading's assignment; a Boolean monitor has already declared it.
std::string reading_declaration(const Context& context, std::uint32_t reading);
/// Returns the condition that one of the monitors is open, "reach_open || avoid_open"; empty if one
/// is sliding or the class is not Boolean.
std::string open_monitors(const Context& context, const std::vector<std::size_t>& monitors);

/// Prints the end of a step of monitors that restart. A repeating one restarts after a final
/// verdict, which is a field of `verdicts`.
void print_progress(Printer& out, const Context& context, std::string_view verdicts);

/// Returns the runtime function that decides the predicate: "is_at_most".
const char* comparison_name(const check::Predicate& predicate);
/// Prints observe_P, set_threshold_P and initial_threshold_P.
void print_adaptive_interface(Printer& out, const Context& context);
void print_adaptation_constants(Printer& out, const Context& context);

// The flight recorder. These print nothing if the plan has none.
/// Returns the type "etlmon::RecorderRow<6, 0, 4>".
std::string recorder_row(const Context& context);
void print_recorder_type(Printer& out, const Context& context);
void print_recorder_constants(Printer& out, const Context& context);
void print_recorder_interface(Printer& out, const Context& context);
/// Prints the recording of a predicate whose distance or expression is `delta`, and of a bool.
void print_recorded(Printer& out, const Context& context, check::Index predicate,
                    const std::string& delta);
void print_recorded_flag(Printer& out, const Context& context, check::Index input,
                         const std::string& flag);
/// Prints the end of a step, with the verdicts in `verdicts`. Call it after print_progress, so that
/// each alarm of a repeating monitor begins an incident.
void print_record(Printer& out, const Context& context, const std::string& verdicts);

// Explanations. These print nothing if values do not carry their sample.
/// Prints the rank that the samples of this step share, at the start of measure().
void print_rank(Printer& out, const Context& context);
/// Prints the count of the step, at the end of measure().
void print_step_measured(Printer& out, const Context& context);
/// Returns the value of a predicate with its sample, whose distance or expression is `delta`; and
/// of a bool.
std::string sourced(const Context& context, check::Index predicate, const std::string& value,
                    const std::string& delta);
std::string sourced_flag(const Context& context, check::Index input, const std::string& value,
                         const std::string& flag);
/// Prints why_NAME(), and the function that they share.
void print_why(Printer& out, const Context& context);
void print_why_of(Printer& out, const Context& context);

/// A data member of the class: its declaration and how reset() sets it.
struct Member {
    std::string type;
    std::string name;
    std::string comment;
    std::string reset;    ///< a statement; empty: the member is kept between episodes
    std::string initial;  ///< empty: zeros, until the constructor or reset() sets it
    /// Index of the monitor whose restart_NAME() resets the member too.
    std::uint32_t begins_with = plan::kNone;
};
std::vector<Member> members(const Context& context);
/// Prints restart_NAME(), and the counts of a repeating monitor.
void print_restarts(Printer& out, const Context& context, const std::vector<Member>& all);
/// Returns the members of readings and streams, as the plan lists them.
std::vector<Member> temporal_members(const Context& context);
/// Returns the members of numbers that earlier steps have a part in.
std::vector<Member> past_members(const Context& context);
/// Returns the comment of registers in an array, from the first to the last: "pending: b U[0, 23]
/// c, ..., b U[0, 0] c". `more`: there are others between them.
std::string comment_of_array(const Context& context, const plan::Member& first,
                             const plan::Member& last, bool more);
std::vector<Member> threshold_members(const Context& context);

// Drifts. These print nothing for a spec without one.
std::vector<Member> drift_members(const Context& context);
/// Prints end_episode(), alarm_D(), drift_D() and what restores it.
void print_drift_interface(Printer& out, const Context& context);
void print_drift_constants(Printer& out, const Context& context);
/// Prints that the drifts of a predicate see its distance or expression at this step, `delta`.
void print_seen(Printer& out, const Context& context, check::Index predicate,
                const std::string& delta);
/// Prints that the drifts of monitors see the verdicts of this step.
void print_seen_verdicts(Printer& out, const Context& context, std::string_view verdicts);

// The parameters of a retargetable class. These print nothing for other classes.
/// Returns a description of the parameters.
std::string about_parameters(const plan::Plan& plan, bool is_calibrated);
/// Prints the offsets of the parameters and the layout of their block.
void print_parameters(Printer& out, const Context& context);
/// Prints the constructors, retarget() and the queries about parameters.
void print_retarget_interface(Printer& out, const Context& context);
/// Prints measure() of a monitor without parameters.
void print_unknown_atoms(Printer& out, const Context& context);
void print_shadow(Printer& out, const Context& context);

// Reference frames. These print nothing for a spec without encoders, or not embedded yet.
bool has_references(const Context& context);
void print_references(Printer& out, const Context& context);
/// Prints encoder_agrees() and encoder_difference().
void print_reference_interface(Printer& out, const Context& context);

// Points of earlier steps. These print nothing for a spec that reads none.
/// Prints the statements that keep this step's points, after everything has been measured.
void print_kept_points(Printer& out, const Context& context);
std::vector<Member> earlier_members(const Context& context);

// Telemetry of named predicates.
std::vector<Member> telemetry_members(const Context& context);
/// Prints distance_P(), threshold_P() and nearest_P().
void print_telemetry(Printer& out, const Context& context);

// Telemetry of lets. These print nothing if the plan has none.
std::vector<Member> let_members(const Context& context);
/// Prints let_NAME() and robustness_NAME().
void print_let_interface(Printer& out, const Context& context);
/// Prints the update of the lets' verdicts, at the end of a step.
void print_lets(Printer& out, const Context& context);

}  // namespace etlc::emit
