// Prints the readings of judge(): robustness and bounds at position 0, given the prefix.
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

/// Returns the number of target elements that a term may have to measure.
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

/// Returns code for a register of the reading. With `seen_from`, array elements are relative to
/// that element, whose index is `i`.
std::string register_text(const Names::OfReading& names, std::uint32_t index,
                          std::uint32_t seen_from = plan::kNone) {
    const std::string& name = names.members[index];
    const std::uint32_t element = names.elements[index];
    if (element == plan::kNone) return name;
    if (seen_from == plan::kNone) return fmt::format("{}[{}]", name, element);
    if (element == seen_from) return name + "[i]";
    return element < seen_from ? fmt::format("{}[i - {}]", name, seen_from - element)
                               : fmt::format("{}[i + {}]", name, element - seen_from);
}

/// Counts the terms from `begin` on that are consecutive elements of an array.
std::size_t neighbours(const Names::OfReading& names, const std::vector<Term>& terms,
                       std::size_t begin) {
    std::size_t end = begin;
    const auto follows = [&] {
        if (terms[end].kind != Term::Kind::reg || names.elements[terms[end].index] == plan::kNone)
            return false;
        return end == begin ||
               (names.members[terms[end].index] == names.members[terms[end - 1].index] &&
                names.elements[terms[end].index] == names.elements[terms[end - 1].index] + 1);
    };
    while (end < terms.size() && follows()) ++end;
    return end - begin;
}

/// Returns code for a term of the reading r, or for one end of it.
std::string text_of(const Context& context, std::uint32_t r, const Term& term, End end,
                    std::uint32_t seen_from = plan::kNone) {
    constexpr std::size_t kMany = 4;  // elements that are combined in one call
    const Names::OfReading& names = context.names.readings[r];
    const std::string part = end == End::both ? "" : end == End::low ? ".low" : ".high";
    switch (term.kind) {
        case Term::Kind::constant:
            if (end == End::both) return context.literal(term.value);
            return context.bound(end == End::low ? term.value.low : term.value.high);
        case Term::Kind::stream:
            if (end != End::both && context.lazy(term.index))
                return fmt::format("static_cast<Value>({}){}", context.value(term.index), part);
            return context.value(term.index) + part;
        case Term::Kind::reg: return register_text(names, term.index, seen_from) + part;
        case Term::Kind::local: return names.locals[term.index] + part;
        case Term::Kind::before:
            return fmt::format("{} < {} ? {} : {}",
                               context.position(context.plan.readings[r].begins_with), term.index,
                               text_of(context, r, term.operands[0], end, seen_from),
                               text_of(context, r, term.operands[1], end, seen_from));
        case Term::Kind::extreme: break;
    }
    std::vector<Term> operands = term.operands;
    std::stable_sort(operands.begin(), operands.end(), [&](const Term& a, const Term& b) {
        return work_of(context, a) < work_of(context, b);
    });
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < operands.size();) {
        const std::size_t count = neighbours(names, operands, i);
        if (count < kMany) {
            texts.push_back(text_of(context, r, operands[i], end, seen_from));
            ++i;
            continue;
        }
        const std::uint32_t first = operands[i].index;
        texts.push_back(fmt::format("etlmon::{}<{}, {}>({}){}", term.max ? "max_in" : "min_in",
                                    names.elements[first], names.elements[first] + count - 1,
                                    names.members[first], part));
        i += count;
    }
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
    const std::string update =
        fmt::format("{} = {};", register_text(names, assignment.index), value);
    const std::string held =
        plan::comment_of(plan::members_of(reading)[assignment.index], context.graph);
    // The formula above the reading's code is not repeated.
    const bool said = held == context.graph.text(reading.node);
    print_with_comment(out,
                       condition.empty() ? update : fmt::format("if ({}) {}", condition, update),
                       said ? "" : held);
}

/// Returns the array element that is assigned at every position; kNone for other assignments.
std::uint32_t assigned_element(const Names::OfReading& names, const plan::Assignment& assignment) {
    const bool always = assignment.positions == ir::Interval{};
    return always && assignment.target == Term::Kind::reg ? names.elements[assignment.index]
                                                          : plan::kNone;
}

/// Counts the assignments from `begin` on that do the same for consecutive elements of an array.
std::size_t alike(const Context& context, std::uint32_t r, std::size_t begin) {
    const Names::OfReading& names = context.names.readings[r];
    const std::vector<plan::Assignment>& list = context.plan.readings[r].straight.assignments;
    const std::uint32_t first = assigned_element(names, list[begin]);
    if (first == plan::kNone) return 1;
    const std::string text = text_of(context, r, list[begin].value, End::both, first);
    std::uint32_t step = 0;
    std::size_t end = begin + 1;
    for (; end < list.size(); ++end) {
        const std::uint32_t element = assigned_element(names, list[end]);
        if (element == plan::kNone) break;
        const std::uint32_t moved = element - assigned_element(names, list[end - 1]);
        if (end == begin + 1) step = moved;
        if (moved != step || (step != 1 && step != UINT32_MAX) ||
            names.members[list[end].index] != names.members[list[begin].index] ||
            text_of(context, r, list[end].value, End::both, element) != text)
            break;
    }
    return end - begin;
}

/// Prints such assignments as a loop.
void print_loop(Printer& out, const Context& context, std::uint32_t r, std::size_t begin,
                std::size_t count) {
    const plan::Straight& code = context.plan.readings[r].straight;
    const Names::OfReading& names = context.names.readings[r];
    const auto& [first, last] =
        std::minmax(code.assignments[begin].index, code.assignments[begin + count - 1].index);
    const bool upwards = code.assignments[begin].index == first;
    print_comment(out, "//",
                  comment_of_array(context, code.registers[first], code.registers[last], true), 4);
    out.open(upwards ? fmt::format("ETLMON_UNROLL for (int i = {}; i <= {}; ++i) {{",
                                   names.elements[first], names.elements[last])
                     : fmt::format("ETLMON_UNROLL for (int i = {}; i >= {}; --i) {{",
                                   names.elements[last], names.elements[first]));
    const std::uint32_t element = names.elements[code.assignments[begin].index];
    print_wrapped(
        out, fmt::format("{}[i] = {};", names.members[first],
                         text_of(context, r, code.assignments[begin].value, End::both, element)));
    out.close();
}

void print_straight(Printer& out, const Context& context, std::uint32_t r) {
    constexpr std::size_t kMany = 3;  // assignments that become a loop
    const plan::Straight& code = context.plan.readings[r].straight;
    for (std::size_t i = 0; i < code.assignments.size();) {
        const std::size_t count = alike(context, r, i);
        if (count >= kMany) {
            print_loop(out, context, r, i, count);
            i += count;
        } else {
            print_assignment(out, context, r, code.assignments[i++]);
        }
    }
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
        out, fmt::format("{} = {}.read({}_pending, {}, {});", reading_declaration(context, r), kept,
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
    print_array(out, "etlmon::Obligations", name + "_pending", table.owed,
                [](etlmon::Obligations pending) {
                    return pending.weak == etlmon::kStrongly
                               ? fmt::format("{{etlmon::kStrongly, {}}}", pending.strong)
                               : fmt::format("{{{}, {}}}", pending.weak, pending.strong);
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
    for (std::uint32_t operand : reading.operands) parts.push_back(context.reading(operand));
    print_wrapped(out, fmt::format("{} = {};", reading_declaration(context, r),
                                   call(reading.max ? "max_of" : "min_of", parts)));
}

void print_tables(Printer& out, const Context& context) {
    const std::vector<Reading>& readings = context.plan.readings;
    if (std::none_of(readings.begin(), readings.end(), plan::table_of)) return;
    print_doc(out,
              "State machines: the transitions into each state, where each list ends, and the "
              "pending obligations of each state.");
    out.line("namespace tables {");
    for (std::uint32_t r = 0; r < readings.size(); ++r)
        if (plan::table_of(readings[r]) != nullptr) print_table(out, context, r);
    out.line("}  // namespace tables");
    out.line();
}

}  // namespace etlc::emit
