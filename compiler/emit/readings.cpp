// The readings of judge(): what the prefix says about position 0.
#include <algorithm>

#include "emit/context.hpp"

namespace etlc::emit {

namespace {

using plan::Fold;
using plan::kNone;
using plan::kUnbounded;
using plan::Machine;
using plan::Reading;
using plan::Slot;

/// A reading from its three parts: on one line where they fit.
void print_parts(Printer& out, const Context& context, std::uint32_t r, const std::string& rho,
                 const std::string& lower, const std::string& upper) {
    const std::string one_line =
        fmt::format("{} = {{{}, {}, {}}};", reading_declaration(context, r), rho, lower, upper);
    if (out.column() + one_line.size() <= kLineWidth) return out.line(one_line);
    out.line("{} = {{", reading_declaration(context, r));
    out.indent();
    print_wrapped(out, rho + ",");
    print_wrapped(out, lower + ",");
    print_wrapped(out, upper);
    out.close("};");
}

/// max(a, key), or what it is where the key is an infinity; min likewise.
std::string widened(const Context& context, bool takes_max, const std::string& value,
                    const std::string& key) {
    const Spelling& spelt = context.spelling;
    if (key == (takes_max ? spelt.top : spelt.bottom)) return key;
    if (key == (takes_max ? spelt.bottom : spelt.top)) return value;
    return fmt::format("{}({}, {})", takes_max ? "max_of" : "min_of", value, key);
}

// ---- latches and folds

void print_latch(Printer& out, const Context& context, std::uint32_t r) {
    const std::string& kept = context.names.readings[r].members[0];
    print_wrapped(out, fmt::format("if (position == 0) {} = {};", kept,
                                   context.value(context.plan.readings[r].latch.operand)));
    out.line("{} = etlmon::settled({});", reading_declaration(context, r), kept);
}

void print_fold(Printer& out, const Context& context, std::uint32_t r) {
    const Fold& fold = context.plan.readings[r].fold;
    const std::vector<std::string>& members = context.names.readings[r].members;
    const std::string& best = members[0];
    const bool takes_max = fold.max;
    const char* widen = takes_max ? "max_of" : "min_of";
    const char* narrow = takes_max ? "min_of" : "max_of";
    const char* end = takes_max ? "high" : "low";
    const bool binary = fold.left != kNone;
    const std::string guard = binary ? members[1] : "";
    const std::string right = context.value(fold.right);
    const std::string step = binary ? fmt::format("{}({}, {})", narrow, guard, right) : right;
    const std::string open = open_condition(fold.interval);

    print_wrapped(
        out, fmt::format("{}{} = {}({}, {});", open.empty() ? "" : fmt::format("if ({}) ", open),
                         best, widen, best, step));
    // Once the right side has decided, the left one matters no more: a Boolean monitor does not ask
    // for it.
    if (binary) {
        const std::string left = context.value(fold.left);
        const bool skips = context.lazy(fold.left);
        print_wrapped(out,
                      fmt::format("{} = {}({}, {});", guard, narrow, guard,
                                  skips ? fmt::format("{}({}, {})", widen, best, left) : left));
    }

    const std::string unseen_key = takes_max ? context.high(fold.unseen) : context.low(fold.unseen);
    const std::string unseen =
        binary ? widened(context, !takes_max, fmt::format("{}.{}", guard, end), unseen_key)
               : unseen_key;
    std::string bound = widened(context, takes_max, fmt::format("{}.{}", best, end), unseen);
    if (fold.interval.bounded())
        bound = fmt::format("position < {} ? {} : {}.{}", fold.interval.high, bound, best, end);
    const std::string known = fmt::format("{}.{}", best, takes_max ? "low" : "high");
    print_parts(out, context, r, best, takes_max ? known : bound, takes_max ? bound : known);
}

// ---- responses

std::string conditional(const std::string& condition, const std::string& statement) {
    return condition.empty() ? statement : fmt::format("if ({}) {}", condition, statement);
}

void print_response(Printer& out, const Context& context, std::uint32_t r) {
    const plan::Response& response = context.plan.readings[r].response;
    const Names::OfReading& names = context.names.readings[r];
    const std::string& settled = names.members[0];
    const char* worst = response.of_always ? "min_of" : "max_of";
    const char* far_end = response.of_always ? "high" : "low";

    print_wrapped(out,
                  conditional(open_condition({response.inner.high, kUnbounded}),
                              fmt::format("{} = {};", settled,
                                          call(worst, {settled, context.value(response.passed)}))));
    std::string now = response.of_always ? context.spelling.no : context.spelling.yes;
    if (response.pending != kNone) now = context.value(response.pending);
    if (response.recent != kNone) {
        print_wrapped(out, fmt::format("const Value {} = {};", names.recent,
                                       call(worst, {now, context.value(response.recent)})));
        now = names.recent;
    }
    const std::string unseen_answer = response.of_always ? context.high(response.unseen_answer)
                                                         : context.low(response.unseen_answer);
    const std::string unseen_body =
        response.of_always ? context.low(response.unseen_body) : context.high(response.unseen_body);
    const char* near_end = response.of_always ? "low" : "high";
    const std::vector<std::string> both = {settled + "." + near_end, now + "." + near_end};
    const std::string known = call(worst, both);
    std::string near = widened(context, !response.of_always, known, unseen_body);
    if (near != known && near != unseen_body) near = call(worst, {both[0], both[1], unseen_body});
    if (response.outer.bounded() && near != known)
        near = fmt::format("position < {} ? {} : {}", response.outer.high, near, known);
    const std::string hope =
        widened(context, response.of_always, now + "." + far_end, unseen_answer);
    const std::string far = widened(context, !response.of_always, settled + "." + far_end, hope);
    print_parts(out, context, r, call(worst, {settled, now}), response.of_always ? near : far,
                response.of_always ? far : near);
}

// ---- unrolled machines

/// min(max of the sources, literals)
std::string term_text(const Context& context, std::uint32_t r, const plan::Term& term) {
    const Machine& machine = context.plan.readings[r].machine;
    const Names::OfReading& names = context.names.readings[r];
    std::vector<std::string> sources;
    for (plan::Source source : term.sources) {
        const bool is_local = source.updated && !machine.program.in_place;
        sources.push_back(
            (is_local ? names.next : names.members)[machine.register_of(source.state)]);
    }
    std::vector<std::string> factors;
    if (!sources.empty()) factors.push_back(call("max_of", sources));
    for (Slot slot : context.by_work(term.literals)) factors.push_back(context.value(slot));
    return factors.empty() ? context.spelling.yes : call("min_of", factors, context.boolean());
}

void print_registers(Printer& out, const Context& context, std::uint32_t r) {
    const Machine& machine = context.plan.readings[r].machine;
    const plan::RegisterProgram& program = machine.program;
    const Names::OfReading& names = context.names.readings[r];
    for (const plan::Update& update : program.updates) {
        std::vector<std::string> terms;
        for (const plan::Term& term : update.terms) terms.push_back(term_text(context, r, term));
        const std::size_t at = machine.register_of(update.state);
        print_wrapped(
            out,
            fmt::format(
                "{} = {};", program.in_place ? names.members[at] : "const Value " + names.next[at],
                terms.empty() ? context.spelling.no : call("max_of", terms, context.boolean())));
    }
    if (program.in_place) return;
    for (const plan::Update& update : program.updates) {
        const std::size_t at = machine.register_of(update.state);
        out.line("{} = {};", names.members[at], names.next[at]);
    }
}

/// The max over states of min(register, key), states with the same key together.
std::string best_of(const Context& context,
                    const std::vector<std::pair<std::string, std::string>>& registers_and_keys) {
    const Spelling& spelt = context.spelling;
    std::vector<std::string> terms;
    std::vector<bool> done(registers_and_keys.size(), false);
    for (std::size_t i = 0; i < registers_and_keys.size(); ++i) {
        if (done[i]) continue;
        const std::string& key = registers_and_keys[i].second;
        std::vector<std::string> same;
        for (std::size_t j = i; j < registers_and_keys.size(); ++j) {
            if (registers_and_keys[j].second != key) continue;
            done[j] = true;
            if (!registers_and_keys[j].first.empty()) same.push_back(registers_and_keys[j].first);
        }
        const bool holds_true =
            std::any_of(registers_and_keys.begin(), registers_and_keys.end(),
                        [&](const auto& e) { return e.second == key && e.first.empty(); });
        if (holds_true)
            terms.push_back(key.empty() ? spelt.top : key);
        else
            terms.push_back(key.empty() ? call("max_of", same)
                                        : fmt::format("min_of({}, {})", call("max_of", same), key));
    }
    if (terms.empty()) return spelt.bottom;
    const bool top = std::find(terms.begin(), terms.end(), spelt.top) != terms.end();
    return top ? spelt.top : call("max_of", terms);
}

void print_unrolled(Printer& out, const Context& context, std::uint32_t r) {
    print_registers(out, context, r);
    const Machine& machine = context.plan.readings[r].machine;
    std::vector<std::string> rho;
    std::vector<std::pair<std::string, std::string>>
        lower;  // register, key; an empty register is always true
    std::vector<std::pair<std::string, std::string>> upper;
    for (std::uint32_t q = 0; q < machine.states.size(); ++q) {
        const Machine::State& owed = machine.states[q];
        const std::string kept =
            owed.always_true ? "" : context.names.readings[r].members[machine.register_of(q)];
        const std::string strong =
            owed.strong_unseen == kNone ? "" : context.high(owed.strong_unseen);
        const std::string weak = owed.weak_unseen == kNone ? "" : context.low(owed.weak_unseen);
        upper.emplace_back(owed.always_true ? "" : kept + ".high",
                           strong == context.spelling.top ? "" : strong);
        if (owed.strong) continue;
        rho.push_back(owed.always_true ? context.spelling.yes : kept);
        lower.emplace_back(owed.always_true ? "" : kept + ".low",
                           weak == context.spelling.top ? "" : weak);
    }
    print_parts(out, context, r, rho.empty() ? context.spelling.no : call("max_of", rho),
                best_of(context, lower), best_of(context, upper));
}

// ---- machines as tables

std::vector<std::string> keys(const Context& context, const std::vector<Slot>& slots, bool high) {
    std::vector<std::string> result{context.spelling.top};
    for (Slot slot : slots) result.push_back(high ? context.high(slot) : context.low(slot));
    return result;
}

std::string list(const std::vector<std::string>& items) {
    std::string text;
    for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
    return "{" + text + "}";
}

void print_table_machine(Printer& out, const Context& context, std::uint32_t r) {
    const Machine& machine = context.plan.readings[r].machine;
    const Names::OfReading& names = context.names.readings[r];
    const std::string& kept = names.members[0];
    std::vector<std::string> guards;
    for (const auto& literals : machine.guards) {
        std::vector<std::string> values;
        for (Slot slot : context.by_work(literals)) values.push_back(context.value(slot));
        guards.push_back(values.empty() ? context.spelling.yes
                                        : call("min_of", values, context.boolean()));
    }
    print_wrapped(out, fmt::format("const Value {}[] = {};", names.guards, list(guards)));
    print_machine_keys(out, context, r, machine.table);
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

/// The table that the reading is emitted as, if it is.
const plan::Table* table_of(const Reading& reading) {
    if (reading.kind == Reading::Kind::machine && !reading.machine.unrolled)
        return &reading.machine.table;
    if (reading.kind == Reading::Kind::pending && !reading.pending.is_fold)
        return &reading.pending.machine.table;
    return nullptr;
}

void print_table(Printer& out, const Context& context, std::uint32_t r) {
    const Reading& reading = context.plan.readings[r];
    const plan::Table& table = *table_of(reading);
    const std::string& name = context.names.readings[r].local;
    print_comment(out, "//",
                  fmt::format("{}: {} states, {} transitions", context.graph.text(reading.node),
                              table.ends.size(), table.transitions.size()),
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

void print_machine_keys(Printer& out, const Context& context, std::uint32_t r,
                        const plan::Table& table) {
    const Names::OfReading& names = context.names.readings[r];
    print_wrapped(out, fmt::format("const Key {}[] = {};", names.weak,
                                   list(keys(context, table.weak, false))));
    print_wrapped(out, fmt::format("const Key {}[] = {};", names.strong,
                                   list(keys(context, table.strong, true))));
}

void print_reading(Printer& out, const Context& context, std::uint32_t r) {
    const Reading& reading = context.plan.readings[r];
    switch (reading.kind) {
        case Reading::Kind::latch: return print_latch(out, context, r);
        case Reading::Kind::fold: return print_fold(out, context, r);
        case Reading::Kind::pending: return print_pending(out, context, r);
        case Reading::Kind::response: return print_response(out, context, r);
        case Reading::Kind::machine:
            return reading.machine.unrolled ? print_unrolled(out, context, r)
                                            : print_table_machine(out, context, r);
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
    if (std::none_of(readings.begin(), readings.end(), table_of)) return;
    print_doc(out,
              "State machines: the transitions into each state, where they end, what each state "
              "owes.");
    out.line("namespace tables {");
    for (std::uint32_t r = 0; r < readings.size(); ++r)
        if (table_of(readings[r]) != nullptr) print_table(out, context, r);
    out.line("}  // namespace tables");
    out.line();
}

}  // namespace etlc::emit
