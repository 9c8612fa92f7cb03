// What the parts of the header emitter share.
// Takes: the plan, the graph for comments, names. Gives: spellings of values, keys, numbers and comments.
// Keeps true: the same plan gives the same bytes on every machine; no path but the spec's file name is printed.
#pragma once

#include <string>
#include <string_view>

#include "emit/names.hpp"
#include "emit/printer.hpp"
#include "plan/budget.hpp"
#include "plan/plan.hpp"

namespace etlc::emit {

struct Context {
    const plan::Plan& plan;
    const ir::Graph& graph;
    const check::Model& model;
    Names names;
    std::string spec_file;  ///< file name without folders
    std::string name_space;

    /// `now.at_a`, a local, a register or a constant: what stands for the stream in judge().
    std::string value(plan::Slot slot) const;
    /// The low or high key of a stream: "reach_.low", "etlmon::key_of(0.31f)".
    std::string low(plan::Slot slot) const;
    std::string high(plan::Slot slot) const;
    /// "dubins.etl:21: F at_a": where a formula stands and its words, or its text where the spec does not say it so.
    std::string place(plan::NodeId node) const;
    std::string place(source::Span span) const;
};

/// "step_ >= 2 && step_ <= 5", empty where the window is always open.
std::string open_condition(ir::Interval interval);
/// A float32 literal that reads back to the same bits: "0.31f".
std::string float_literal(float x);
std::string key_literal(plan::Key key);
std::string value_literal(plan::Value value);
/// `text` broken at commas and operators so that no line is longer than kLineWidth, continued four spaces deeper.
void print_wrapped(Printer& out, const std::string& text);
/// Declarations with their comments in one column.
void print_aligned(Printer& out, const std::vector<std::pair<std::string, std::string>>& declarations);
/// "max(a, b, c)"; of one argument, that argument.
std::string call(std::string_view function, const std::vector<std::string>& arguments);

// The parts of the header, in order.
void print_summary(Printer& out, const Context& context);
void print_inputs_and_verdicts(Printer& out, const Context& context);
void print_constants(Printer& out, const Context& context);
void print_measure(Printer& out, const Context& context);
void print_judge(Printer& out, const Context& context);
void print_streams(Printer& out, const Context& context);
void print_reading(Printer& out, const Context& context, std::uint32_t reading);
void print_tables(Printer& out, const Context& context);
void print_pending(Printer& out, const Context& context, std::uint32_t reading);
/// Of machines as tables: the lists of keys that say what the states are worth, as locals.
void print_machine_keys(Printer& out, const Context& context, std::uint32_t reading, const plan::Machine& machine);
std::string table_name(const Context& context, std::uint32_t reading);

/// A data member of the class: its declaration and how reset() sets it.
struct Member {
    std::string type;
    std::string name;
    std::string comment;
    std::string reset;  ///< a statement
};
std::vector<Member> members(const Context& context);
std::vector<Member> stream_members(const Context& context);
std::vector<Member> reading_members(const Context& context);
std::vector<Member> pending_members(const Context& context, std::uint32_t reading);

}  // namespace etlc::emit
