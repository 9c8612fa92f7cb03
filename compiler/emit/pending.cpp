// Readings over formulas whose windows still reach past the prefix: evaluated anew at the last
// positions.
#include "emit/context.hpp"

namespace etlc::emit {

namespace {

using plan::kNone;
using plan::Pending;

/// A part's readings at the last positions: computed from its operands, oldest position first.
void print_part(Printer& out, const Context& context, const Pending& pending,
                const Names::PendingNames& names, std::size_t index) {
    const Pending::Part& part = pending.parts[index];
    const std::string& array = names.parts[index];
    out.line("Reading {}[{}];", array, pending.horizon + 1);
    if (part.leaf != kNone) {
        out.line("{}.push({});", names.leaves[index], context.value(part.leaf));
        out.line("{}.list({}, {});", names.leaves[index], array, names.count);
        return;
    }
    out.line("// {}", context.graph.text(part.node));
    if (part.unseen == kNone) {
        const char* function = part.op == ir::Op::conjunction ? "pending_and" : "pending_or";
        std::string left = names.parts[part.operands[0]];
        for (std::size_t i = 1; i < part.operands.size(); ++i) {
            out.line("etlmon::{}({}, {}, {}, {});", function, left, names.parts[part.operands[i]],
                     array, names.count);
            left = array;
        }
        return;
    }
    const bool max = ir::takes_max(part.op);
    const std::string left = part.operands.size() == 2 ? names.parts[part.operands[0]] : "nullptr";
    print_wrapped(out,
                  fmt::format("etlmon::pending_at_each<etlmon::{}>({}, {}, {}, {}, {}, {}, {});",
                              max ? "Seeking" : "Guarding", left, names.parts[part.operands.back()],
                              array, names.count, part.interval.low, part.interval.high,
                              max ? context.high(part.unseen) : context.low(part.unseen)));
}

void print_fold(Printer& out, const Context& context, std::uint32_t r) {
    const Pending& pending = context.plan.readings[r].pending;
    const Names::PendingNames& names = context.names.pending.at(r);
    const plan::Fold& fold = pending.fold;
    const bool max = ir::takes_max(fold.op);
    const std::string left = fold.left == kNone ? "nullptr" : names.parts[fold.left];
    const std::string end =
        fold.interval.bounded() ? fmt::format("{}", fold.interval.high) : "etlmon::kWithoutEnd";
    print_wrapped(
        out, fmt::format("{} = etlmon::pending_from_start<etlmon::{}>({}, {}, {}, {}, {}, "
                         "position, {}, {}, {}, {});",
                         reading_declaration(context, r), max ? "Seeking" : "Guarding",
                         context.names.reading_member.at(r), context.names.guard_member.at(r), left,
                         names.parts[fold.right], names.count, pending.horizon, fold.interval.low,
                         end, max ? context.high(fold.unseen) : context.low(fold.unseen)));
}

void print_machine(Printer& out, const Context& context, std::uint32_t r) {
    const Pending& pending = context.plan.readings[r].pending;
    const Names::PendingNames& names = context.names.pending.at(r);
    const Names::TableLocals& locals = context.names.table_locals.at(r);
    out.line("Reading {}[{}][{}];", locals.guards, pending.horizon + 1, pending.guards.size());
    out.open(fmt::format("for (uint32_t i = 0; i < {0}; ++i) {{", names.count));
    for (std::size_t g = 0; g < pending.guards.size(); ++g) {
        std::vector<std::string> literals;
        for (std::uint32_t part : pending.guards[g]) literals.push_back(names.parts[part] + "[i]");
        print_wrapped(out, fmt::format("{}[i][{}] = {};", locals.guards, g,
                                       literals.empty() ? fmt::format("etlmon::settled({})",
                                                                      context.spelling.yes)
                                                        : call("min_of", literals)));
    }
    out.close();
    print_machine_keys(out, context, r, pending.machine);
    const std::string tables = "tables::" + table_name(context, r);
    print_wrapped(
        out, fmt::format(
                 "{} = {}.read({}, {}, position >= {}, {}_transitions, {}_ends, {}_owed, {}, {});",
                 reading_declaration(context, r), context.names.reading_member.at(r), locals.guards,
                 names.count, pending.horizon, tables, tables, tables, locals.weak, locals.strong));
}

}  // namespace

void print_pending(Printer& out, const Context& context, std::uint32_t r) {
    const Pending& pending = context.plan.readings[r].pending;
    const Names::PendingNames& names = context.names.pending.at(r);
    out.line("// evaluated anew at the last {} positions, whose windows reach past this step",
             pending.horizon + 1);
    out.line("const uint32_t {0} = position < {1} ? position + 1 : {2};", names.count,
             pending.horizon, pending.horizon + 1);
    for (std::size_t i = 0; i < pending.parts.size(); ++i)
        print_part(out, context, pending, names, i);
    pending.is_fold ? print_fold(out, context, r) : print_machine(out, context, r);
}

std::vector<Member> pending_members(const Context& context, std::uint32_t r) {
    const plan::Reading& reading = context.plan.readings[r];
    const Pending& pending = reading.pending;
    const std::string text = context.graph.text(reading.node);
    std::vector<Member> result;
    for (std::size_t i = 0; i < pending.parts.size(); ++i) {
        const std::string& leaf = context.names.pending.at(r).leaves[i];
        if (leaf.empty()) continue;
        result.push_back({fmt::format("etlmon::Recent<Value, {}>", pending.horizon + 1), leaf,
                          context.graph.text(pending.parts[i].node), leaf + ".reset();"});
    }
    const std::string& name = context.names.reading_member.at(r);
    if (!pending.is_fold) {
        result.push_back({fmt::format("etlmon::PendingMachine<Value, {}, {}>",
                                      pending.machine.states.size(), pending.guards.size()),
                          name, text, name + ".reset();"});
        return result;
    }
    const bool max = ir::takes_max(pending.fold.op);
    const std::string& guard = context.names.guard_member.at(r);
    result.push_back(
        {"Value", name, text + ", where it is settled",
         fmt::format("{} = {};", name, max ? context.spelling.no : context.spelling.yes)});
    result.push_back(
        {"Value", guard, "what its left side lets through there",
         fmt::format("{} = {};", guard, max ? context.spelling.yes : context.spelling.no)});
    return result;
}

}  // namespace etlc::emit
