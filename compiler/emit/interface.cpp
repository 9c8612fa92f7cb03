// Prints the inputs and verdicts of the class, and its constants.
#include <algorithm>

#include "diag/diag.hpp"
#include "emit/context.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::emit {

namespace {

using check::Index;
using check::InputType;

std::string type_of(const check::Input& input) {
    switch (input.type) {
        case InputType::scalar: return "float";
        case InputType::boolean: return "etlmon::Flag";
        case InputType::f32: return fmt::format("etlmon::Vector<float, {}>", input.dimension);
        case InputType::f16: return fmt::format("etlmon::Vector<uint16_t, {}>", input.dimension);
        case InputType::i8: return fmt::format("etlmon::Vector<int8_t, {}>", input.dimension);
    }
    return "";
}

std::string remark_on(const check::Input& input) {
    std::string text;
    const auto add = [&](const std::string& remark) {
        text += (text.empty() ? "" : "; ") + remark;
    };
    if (input.has_range)
        add(fmt::format("in [{}, {}]; outside counts as missing", input.range.low,
                        input.range.high));
    if (input.type == InputType::f16) add("IEEE bits of float16");
    if (input.type == InputType::i8) add(fmt::format("value = {} x integer", input.scale));
    if (input.stale_after > 0)
        add(input.stale_after == 1
                ? "missing where it repeats"
                : fmt::format("missing after {} equal samples in a row", input.stale_after));
    if (input.hold > 0)
        add(fmt::format("held for {} missing step{}", input.hold, input.hold == 1 ? "" : "s"));
    if (input.missing) add(fmt::format("counts as {} when missing", *input.missing));
    return text;
}

/// Prints `alignas(64) inline constexpr TYPE NAME[SIZE] = {...};`, one row per line. A row of
/// several lines has its number above it.
template <class Number, class Spell>
void print_array(Printer& out, const std::string& type_and_name, const std::string& size,
                 const std::vector<Number>& numbers, std::size_t row_length, Spell spell) {
    out.line("alignas(64) inline constexpr {}[{}] = {{", type_and_name, size);
    out.indent();
    for (std::size_t begin = 0; begin < numbers.size(); begin += row_length) {
        std::vector<std::string> lines(1);
        for (std::size_t i = begin; i < begin + row_length; ++i) {
            const std::string number = spell(numbers[i]) + (i + 1 < numbers.size() ? "," : "");
            if (out.column() + lines.back().size() + 1 + number.size() > kLineWidth)
                lines.emplace_back();
            lines.back() += (lines.back().empty() ? "" : " ") + number;
        }
        if (lines.size() > 1 && numbers.size() > row_length)
            out.line("// row {}", begin / row_length);
        for (const std::string& line : lines) out.line(line);
    }
    out.close("};");
}

void print_numbers(Printer& out, const std::string& name, const std::string& size,
                   const std::vector<float>& numbers, std::size_t row_length) {
    print_array(out, "float " + name, size, numbers, row_length, float_literal);
}

void print_place(Printer& out, const Context& context, const std::string& name,
                 const plan::StoredSet& set) {
    print_doc(out, fmt::format("offset in {}, in floats", context.targets_file));
    out.line("inline constexpr size_t {} = {};", name, set.offset / sizeof(float));
}

std::string rows_of(const check::Target& target, const check::Distance& distance) {
    return fmt::format("{}: {} of {}{}{}", target.origin,
                       target.rows == 1 ? "one row" : fmt::format("{} rows", target.rows),
                       diag::counted(target.dimension, "element"),
                       target.source == check::kNone ? "" : ", projected",
                       plan::rows_as_given(distance) ? "" : ", scaled to length 1");
}

/// Prints the matrices and offsets of projections.
void print_projections(Printer& out, const Context& context) {
    if (context.names.matrix_array.empty()) return;
    out.line("/// Projections A (z - m): A row by row, then m.");
    out.line("namespace projections {");
    for (const auto& [index, name] : context.names.matrix_array) {
        const check::Projection& projection = context.model.projections[index];
        print_doc(out, fmt::format("{}: {} of {}", projection.origin,
                                   projection.rows == 1 ? "one row"
                                                        : fmt::format("{} rows", projection.rows),
                                   diag::counted(projection.dimension, "element")));
        if (const plan::StoredSet* set = plan::stored_projection(context.plan, index))
            print_place(out, context, name, *set);
        else
            print_numbers(out, name, fmt::format("{} * {}", projection.rows, projection.dimension),
                          projection.matrix, projection.dimension);
        const auto offset = context.names.offset_array.find(index);
        if (offset == context.names.offset_array.end()) continue;
        print_doc(out, fmt::format("offset m of {}", projection.name));
        print_numbers(out, offset->second, fmt::format("{}", projection.dimension),
                      projection.offset, projection.dimension);
    }
    out.line("}  // namespace projections");
    out.line();
}

void print_rows(Printer& out, const Context& context, Index d) {
    const check::Distance& distance = context.model.distances[d];
    const check::Target& target = context.model.targets[distance.target];
    print_doc(out, rows_of(target, distance));
    if (const plan::StoredSet* set = plan::stored_set(context.plan, d)) {
        return print_place(out, context, context.names.target_array.at(d), *set);
    }
    print_numbers(out, context.names.target_array.at(d),
                  fmt::format("{} * {}", target.rows, target.dimension),
                  plan::prepared_rows(context.model, distance), target.dimension);
}

void print_narrow_rows(Printer& out, const Context& context, const plan::NarrowSet& set) {
    const check::Distance& distance = context.model.distances[set.distance];
    const bool halves = set.storage == plan::Storage::f16;
    print_doc(out,
              fmt::format("{}; as {}{}", rows_of(context.model.targets[distance.target], distance),
                          halves ? "the bits of float16"
                                 : fmt::format("int8, value = {} x integer", set.scale),
                          set.lossless ? ", which hold them exactly" : ""));
    const std::string& name = context.names.narrow_array.at(set.distance);
    const std::string size = fmt::format("{} * {}", set.rows, set.dimension);
    if (halves)
        print_array(out, "uint16_t " + name, size, set.halves, set.dimension,
                    [](std::uint16_t x) { return fmt::format("0x{:04x}", x); });
    else
        print_array(out, "int8_t " + name, size, set.bytes, set.dimension,
                    [](std::int8_t x) { return fmt::format("{}", x); });
}

/// Prints named(), for loops over all verdicts.
void print_named(Printer& out, const Context& context) {
    const std::vector<plan::Monitor>& monitors = context.plan.monitors;
    print_doc(out,
              "Returns the verdicts with their names: for (const auto& [name, verdict] : "
              "named(verdicts)) ...");
    out.open(fmt::format("inline etlmon::Named<{}, {}> named(const Verdicts& verdicts) noexcept {{",
                         context.spelling.verdict, monitors.size()));
    out.open("return {{");
    for (std::size_t m = 0; m < monitors.size(); ++m)
        out.line("{{\"{0}\", verdicts.{0}}}{1}", monitors[m].name,
                 m + 1 < monitors.size() ? "," : "");
    out.close("}};");
    out.close();
    out.line();
}

}  // namespace

void print_inputs_and_verdicts(Printer& out, const Context& context) {
    print_doc(out, "The inputs of one step. In Inputs{} all of them are missing.");
    out.open("struct Inputs {");
    std::vector<std::pair<std::string, std::string>> inputs;
    for (Index i : context.plan.inputs) {
        const check::Input& input = context.model.inputs[i];
        inputs.emplace_back(
            fmt::format("{} {}{};", type_of(input), input.name,
                        input.type == InputType::scalar ? " = etlmon::kMissing" : ""),
            remark_on(input));
    }
    print_aligned(out, inputs);
    out.close("};");
    out.line();
    const bool restarts =
        std::any_of(context.plan.monitors.begin(), context.plan.monitors.end(),
                    [](const auto& monitor) { return monitor.restarts != check::Restarts::never; });
    print_doc(out, fmt::format("The verdicts of one step. A prefix monitor judges the prefix so "
                               "far{}; a sliding monitor judges the position one horizon ago.",
                               restarts ? ", from its last restart on" : ""));
    out.open("struct Verdicts {");
    std::vector<std::pair<std::string, std::string>> verdicts;
    for (const plan::Monitor& monitor : context.plan.monitors)
        verdicts.emplace_back(fmt::format("{} {};", context.spelling.verdict, monitor.name),
                              context.place(context.model.monitors[monitor.index].span));
    print_aligned(out, verdicts);
    out.close("};");
    out.line();
    print_named(out, context);
}

void print_constants(Printer& out, const Context& context) {
    if (context.plan.distances.empty()) return;
    if (context.stores_targets()) {
        print_doc(out, fmt::format("The bytes of {}, mapped by etlmon/hosted/mapped_targets.hpp or "
                                   "linked in at a multiple of 64. The type holds their size and "
                                   "XXH64, and is ready with no other bytes.",
                                   context.targets_file));
        out.line("using Targets = etlmon::Targets<{}u, 0x{:016x}u>;",
                 plan::stored_bytes(context.plan), plan::stored_hash(context.plan));
        out.line();
    }
    print_projections(out, context);
    out.line("/// Target sets, row by row.");
    out.line("namespace targets {");
    std::set<std::string> done;
    for (Index d : context.plan.distances) {
        const plan::NarrowSet* narrow = plan::narrow_set(context.plan, d);
        if (narrow != nullptr && done.insert(context.names.narrow_array.at(d)).second)
            print_narrow_rows(out, context, *narrow);
        const bool has_rows = !context.model.distances[d].is_between_points();
        if (has_rows && !context.lossless(d) &&
            done.insert(context.names.target_array.at(d)).second)
            print_rows(out, context, d);
        const auto weights = context.names.weight_array.find(d);
        if (weights == context.names.weight_array.end()) continue;
        const check::Distance& distance = context.model.distances[d];
        print_doc(out, fmt::format("weights of {}", distance.text));
        const std::size_t dimension = context.model.dimension_of(d);
        print_numbers(out, weights->second, fmt::format("{}", distance.weights.size()),
                      distance.weights, dimension);
    }
    out.line("}  // namespace targets");
    out.line();
}

}  // namespace etlc::emit
