// The readings of judge(): what the prefix says about position 0.
#include <fmt/ranges.h>

#include <algorithm>

#include "emit/context.hpp"

namespace etlc::emit {

namespace {

using plan::End;
using plan::Reading;
using plan::Slot;
using plan::Term;

// ---- straight-line code

/// Target elements that a term may have to measure.
std::uint64_t work_of(const Context& context, const Term& term) {
    std::uint64_t sum = term.kind == Term::Kind::stream ? context.work(term.index) : 0;
    for (const Term& operand : term.operands) sum += work_of(context, operand);
    return sum;
}

bool is_lazy(const Context& context, const Term& term) {
    if (term.kind == Term::Kind::stream) return context.lazy(term.index);
    return std::any_of(term.operands.begin(), term.operands.end(),
                       [&](const Term& operand) { return is_lazy(context, operand); });
}

/// The term in C++: of the reading r, whole or at one end.
std::string text_of(const Context& context, std::uint32_t r, const Term& term, End end) {
    const Names::OfReading& names = context.names.readings[r];
    const std::string part = end == End::both ? "" : end == End::low ? ".low" : ".high";
    switch (term.kind) {
        case Term::Kind::constant:
            if (end == End::both) return context.literal(term.value);
            return context.bound(end == End::low ? term.value.low : term.value.high);
        case Term::Kind::stream: return context.value(term.index) + part;
        case Term::Kind::reg: return names.members[term.index] + part;
        case Term::Kind::local: return names.locals[term.index] + part;
        case Term::Kind::before:
            return fmt::format("{} < {} ? {} : {}",
                               context.position(context.plan.readings[r].begins_with), term.index,
                               text_of(context, r, term.operands[0], end),
                               text_of(context, r, term.operands[1], end));
        case Term::Kind::extreme: break;
    }
    std::vector<Term> operands = term.operands;
    std::stable_sort(operands.begin(), operands.end(), [&](const Term& a, const Term& b) {
        return work_of(context, a) < work_of(context, b);
    });
    std::vector<std::string> texts;
    for (const Term& operand : operands) texts.push_back(text_of(context, r, operand, end));
    return call(term.max ? "max_of" : "min_of", texts, is_lazy(context, term));
}

void print_assignment(Printer& out, const Context& context, std::uint32_t r,
                      const plan::Assignment& assignment) {
    const Names::OfReading& names = context.names.readings[r];
    const std::string value = text_of(context, r, assignment.value, End::both);
    if (assignment.target == Term::Kind::local)
        return print_wrapped(
            out, fmt::format("const Value {} = {};", names.locals[assignment.index], value));
    const plan::Reading& reading = context.plan.readings[r];
    const std::string condition =
        assignment.positions == ir::Interval{}
            ? ""
            : open_condition(assignment.positions, context.position(reading.begins_with));
    const std::string update = fmt::format("{} = {};", names.members[assignment.index], value);
    const std::string held =
        plan::comment_of(plan::members_of(reading)[assignment.index], context.graph);
    // What stands above the reading's code is not said again.
    const bool said = held == context.graph.text(reading.node);
    print_with_comment(out,
                       condition.empty() ? update : fmt::format("if ({}) {}", condition, update),
                       said ? "" : held);
}

void print_straight(Printer& out, const Context& context, std::uint32_t r) {
    const plan::Straight& code = context.plan.readings[r].straight;
    for (const plan::Assignment& assignment : code.assignments)
        print_assignment(out, context, r, assignment);
    const std::string declaration = reading_declaration(context, r);
    const std::string rho = text_of(context, r, code.rho, End::both);
    if (code.lower == code.rho && code.upper == code.rho)
        return print_wrapped(out, fmt::format("{} = etlmon::settled({});", declaration, rho));
    const std::string lower = text_of(context, r, code.lower, End::low);
    const std::string upper = text_of(context, r, code.upper, End::high);
    const std::string one_line =
        fmt::format("{} = {{{}, {}, {}}};", declaration, rho, lower, upper);
    if (out.column() + one_line.size() <= kLineWidth) return out.line(one_line);
    out.line("{} = {{", declaration);
    out.indent();
    print_wrapped(out, rho + ",");
    print_wrapped(out, lower + ",");
    print_wrapped(out, upper);
    out.close("};");
}

// ---- tables

std::string list(const std::vector<std::string>& items) {
    return fmt::format("{{{}}}", fmt::join(items, ", "));
}

void print_table_machine(Printer& out, const Context& context, std::uint32_t r) {
    const plan::Table& table = context.plan.readings[r].table;
    const Names::OfReading& names = context.names.readings[r];
    const std::string& kept = names.members[0];
    std::vector<std::string> guards;
    for (const std::vector<Slot>& slots : table.guards) {
        std::vector<Term> streams;
        for (Slot slot : slots) streams.push_back(Term::stream(slot));
        guards.push_back(text_of(context, r, Term::extreme(false, std::move(streams)), End::both));
    }
    print_wrapped(out, fmt::format("const Value {}[] = {};", names.guards, list(guards)));
    print_machine_keys(out, context, r);
    const std::string tables = "tables::" + names.local;
    print_wrapped(out, fmt::format("{}.advance({}_transitions, {}_ends, {});", kept, tables, tables,
                                   names.guards));
    print_wrapped(
        out, fmt::format("{} = {}.read({}_owed, {}, {});", reading_declaration(context, r), kept,
                         tables, names.weak, names.strong));
}

template <class Items, class Spell>
void print_array(Printer& out, const std::string& type, const std::string& name, const Items& items,
                 Spell spell) {
    std::string text = fmt::format("inline constexpr {} {}[] = {{", type, name);
    for (std::size_t i = 0; i < items.size(); ++i) text += (i == 0 ? "" : ", ") + spell(items[i]);
    print_wrapped(out, text + "};");
}

void print_table(Printer& out, const Context& context, std::uint32_t r) {
    const Reading& reading = context.plan.readings[r];
    const plan::Table& table = *plan::table_of(reading);
    const std::string& name = context.names.readings[r].local;
    print_comment(out, "//",
                  fmt::format("{} states, {} transitions: {}", table.ends.size(),
                              table.transitions.size(), context.graph.text(reading.node)),
                  4);
    print_array(out, "etlmon::Transition", name + "_transitions", table.transitions,
                [](etlmon::Transition t) { return fmt::format("{{{}, {}}}", t.source, t.guard); });
    print_array(out, "uint32_t", name + "_ends", table.ends,
                [](std::uint32_t end) { return fmt::format("{}", end); });
    print_array(out, "etlmon::Owed", name + "_owed", table.owed, [](etlmon::Owed owed) {
        return owed.weak == etlmon::kStrongly
                   ? fmt::format("{{etlmon::kStrongly, {}}}", owed.strong)
                   : fmt::format("{{{}, {}}}", owed.weak, owed.strong);
    });
}

}  // namespace

void print_machine_keys(Printer& out, const Context& context, std::uint32_t r) {
    const plan::Table& table = *plan::table_of(context.plan.readings[r]);
    const Names::OfReading& names = context.names.readings[r];
    std::vector<std::string> weak{context.spelling.top};
    std::vector<std::string> strong{context.spelling.top};
    for (Slot slot : table.weak) weak.push_back(context.low(slot));
    for (Slot slot : table.strong) strong.push_back(context.high(slot));
    print_wrapped(out, fmt::format("const Key {}[] = {};", names.weak, list(weak)));
    print_wrapped(out, fmt::format("const Key {}[] = {};", names.strong, list(strong)));
}

void print_reading(Printer& out, const Context& context, std::uint32_t r) {
    const Reading& reading = context.plan.readings[r];
    switch (reading.kind) {
        case Reading::Kind::straight: return print_straight(out, context, r);
        case Reading::Kind::table: return print_table_machine(out, context, r);
        case Reading::Kind::pending: return print_pending(out, context, r);
        case Reading::Kind::combination: break;
    }
    std::vector<std::string> parts;
    for (std::uint32_t operand : reading.operands)
        parts.push_back(context.names.readings[operand].local);
    print_wrapped(out, fmt::format("{} = {};", reading_declaration(context, r),
                                   call(reading.max ? "max_of" : "min_of", parts)));
}

void print_tables(Printer& out, const Context& context) {
    const std::vector<Reading>& readings = context.plan.readings;
    if (std::none_of(readings.begin(), readings.end(), plan::table_of)) return;
    print_doc(out,
              "State machines: the transitions into each state, where they end, what each state "
              "owes.");
    out.line("namespace tables {");
    for (std::uint32_t r = 0; r < readings.size(); ++r)
        if (plan::table_of(readings[r]) != nullptr) print_table(out, context, r);
    out.line("}  // namespace tables");
    out.line();
}

}  // namespace etlc::emit
