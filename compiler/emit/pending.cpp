// Prints readings of formulas whose windows extend beyond the prefix, which are evaluated again at
// the last positions.
#include "emit/context.hpp"

namespace etlc::emit {

namespace {

using plan::kNone;
using plan::Pending;

/// Prints the readings of a part at the last positions, oldest first, from those of its operands.
void print_part(Printer& out, const Context& context, const Pending& pending,
                const Names::OfReading& names, std::size_t index, const std::string& leaf) {
    const Pending::Part& part = pending.parts[index];
    const std::string& array = names.parts[index];
    out.line("Reading {}[{}];", array, pending.horizon + 1);
    if (part.leaf != kNone) {
        out.line("{}.push({});", leaf, context.value(part.leaf));
        out.line("{}.list({}, {});", leaf, array, names.count);
        return;
    }
    print_comment(out, "//", context.graph.text(part.node), 4);
    if (part.unseen == kNone) {
        const char* function = part.max ? "pending_or" : "pending_and";
        std::string left = names.parts[part.operands[0]];
        for (std::size_t i = 1; i < part.operands.size(); ++i) {
            print_wrapped(out, fmt::format("etlmon::{}({}, {}, {}, {});", function, left,
                                           names.parts[part.operands[i]], array, names.count));
            left = array;
        }
        return;
    }
    const bool max = part.max;
    const std::string left = part.operands.size() == 2 ? names.parts[part.operands[0]] : "nullptr";
    print_wrapped(out,
                  fmt::format("etlmon::pending_at_each<etlmon::{}>({}, {}, {}, {}, {}, {}, {});",
                              max ? "Seeking" : "Guarding", left, names.parts[part.operands.back()],
                              array, names.count, part.interval.low, part.interval.high,
                              max ? context.high(part.unseen) : context.low(part.unseen)));
}

/// Returns code for the number of steps since the reading began.
const std::string& position(const Context& context, std::uint32_t r) {
    return context.position(context.plan.readings[r].begins_with);
}

void print_fold(Printer& out, const Context& context, std::uint32_t r) {
    const Pending& pending = context.plan.readings[r].pending;
    const Names::OfReading& names = context.names.readings[r];
    const Pending::Part& fold = pending.fold;
    const bool max = fold.max;
    const std::string left = fold.operands.size() == 2 ? names.parts[fold.operands[0]] : "nullptr";
    const std::string end =
        fold.interval.bounded() ? fmt::format("{}", fold.interval.high) : "etlmon::kWithoutEnd";
    print_wrapped(out,
                  fmt::format("{} = etlmon::pending_from_start<etlmon::{}>({}, {}, {}, {}, {}, "
                              "{}, {}, {}, {}, {});",
                              reading_declaration(context, r), max ? "Seeking" : "Guarding",
                              *(names.members.end() - 2), names.members.back(), left,
                              names.parts[fold.operands.back()], names.count, position(context, r),
                              pending.horizon, fold.interval.low, end,
                              max ? context.high(fold.unseen) : context.low(fold.unseen)));
}

void print_machine(Printer& out, const Context& context, std::uint32_t r) {
    const Pending& pending = context.plan.readings[r].pending;
    const Names::OfReading& names = context.names.readings[r];
    out.line("Reading {}[{}][{}];", names.guards, pending.horizon + 1, pending.table.guards.size());
    out.open(fmt::format("for (uint32_t i = 0; i < {0}; ++i) {{", names.count));
    for (std::size_t g = 0; g < pending.table.guards.size(); ++g) {
        std::vector<std::string> literals;
        for (std::uint32_t part : pending.table.guards[g])
            literals.push_back(names.parts[part] + "[i]");
        print_wrapped(out,
                      fmt::format("{}[i][{}] = {};", names.guards, g,
                                  literals.empty() ? fmt::format("etlmon::settled({})",
                                                                 context.literal(etlmon::kTrue))
                                                   : call("min_of", literals)));
    }
    out.close();
    print_machine_keys(out, context, r);
    const std::string tables = "tables::" + names.local;
    print_wrapped(
        out,
        fmt::format("{} = {}.read({}, {}, {} >= {}, {}_transitions, {}_ends, {}_pending, {}, {});",
                    reading_declaration(context, r), names.members.back(), names.guards,
                    names.count, position(context, r), pending.horizon, tables, tables, tables,
                    names.weak, names.strong));
}

}  // namespace

void print_pending(Printer& out, const Context& context, std::uint32_t r) {
    const Pending& pending = context.plan.readings[r].pending;
    const Names::OfReading& names = context.names.readings[r];
    out.line("// evaluated again at the last {} positions, whose windows extend beyond this step",
             pending.horizon + 1);
    out.line("const uint32_t {0} = {3} < {1} ? {3} + 1 : {2};", names.count, pending.horizon,
             pending.horizon + 1, position(context, r));
    auto leaf = names.members.begin();  // members of leaves come first
    for (std::size_t i = 0; i < pending.parts.size(); ++i) {
        print_part(out, context, pending, names, i, *leaf);
        if (pending.parts[i].leaf != kNone) ++leaf;
    }
    pending.is_fold ? print_fold(out, context, r) : print_machine(out, context, r);
}

}  // namespace etlc::emit
