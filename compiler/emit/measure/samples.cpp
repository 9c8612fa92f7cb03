// Prints the samples of a step in measure(): checks that they are present, and declares their
// locals.
#include "emit/measure/measurements.hpp"
#include "plan/program/value_type.hpp"
#include "plan/targets/kernels.hpp"

namespace etlc::emit {

using check::Index;
using check::InputType;

namespace {

/// Returns whether later steps read this sample of an embedding.
bool is_kept(const Context& context, Index i) {
    return std::any_of(context.names.earlier_member.begin(), context.names.earlier_member.end(),
                       [&](const auto& earlier) {
                           const check::Point& point = context.model.points[earlier.first];
                           return point.kind == check::Point::Kind::embedding &&
                                  point.inputs[0] == i;
                       });
}

/// Returns whether an input is read on demand. One with `hold` or `stale after`, or that later
/// steps read, is read at every step.
bool on_demand(const Context& context, Index i) {
    return context.on_demand && !context.model.inputs[i].has_state() && !is_kept(context, i);
}

std::string accepted(const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    const std::string range = input.has_range
                                  ? fmt::format(", {}, {}", float_literal(input.range.low),
                                                float_literal(input.range.high))
                                  : "";
    const std::string sample = fmt::format("etlmon::accept(in.{}{})", input.name, range);
    if (input.stale_after == 0) return sample;
    return fmt::format("{}.accept({})", context.names.stale_member.at(i), sample);
}

/// Returns the condition that the embedding is present and not stale, as far as its kernels do not
/// check it.
std::string present(const Context& context, Index i) {
    const std::string& name = context.model.inputs[i].name;
    if (plan::left_to_kernels(context.plan, i)) return fmt::format("in.{}.present()", name);
    const auto stale = context.names.stale_member.find(i);
    const std::string fresh =
        stale == context.names.stale_member.end()
            ? ""
            : fmt::format(" && {}.accepts(in.{}.data())", stale->second, name);
    return fmt::format("etlmon::present(in.{}){}", name, fresh);
}

std::string widening(const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    const std::string& buffer = context.names.input_buffer.at(i);
    if (input.type == InputType::f16)
        return fmt::format("etlmon::widen_f16(in.{}.data(), {}, {});", input.name, buffer,
                           input.dimension);
    return fmt::format("etlmon::widen_i8(in.{}.data(), {}, {}, {});", input.name,
                       float_literal(input.scale), buffer, input.dimension);
}

bool is_widened(const check::Input& input) {
    return input.type == InputType::f16 || input.type == InputType::i8;
}

void print_widened(Printer& out, const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    const std::string& local = context.names.input_local.at(i);
    const std::string& buffer = context.names.input_buffer.at(i);
    out.line("float {}[{}];", buffer, input.dimension);
    out.line("const float* {} = nullptr;", local);
    print_wrapped(out, fmt::format("if ({}) {{", present(context, i)));
    out.indent();
    print_wrapped(out, widening(context, i));
    out.line("{} = {};", local, buffer);
    out.close();
}

/// Returns a bool with `hold` as a Flag.
std::string held_flag(const std::string& word) {
    return fmt::format("{0} != nullptr ? etlmon::Flag(*{0} != 0) : etlmon::Flag()", word);
}

/// Returns the last argument of truth_of and value_of: the value of a missing bool.
std::string missing_flag(const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    return input.missing ? ", " + context.atom_literal(plan::missing_value(input)) : "";
}

void print_flag_atom(Printer& out, const Context& context, Index i, const std::string& flag) {
    const std::string value = fmt::format("etlmon::value_of({}{})", flag, missing_flag(context, i));
    print_wrapped(out, fmt::format("now.{} = {};", context.names.flag_atom.at(i),
                                   sourced_flag(context, i, value, flag)));
}

void print_flag(Printer& out, const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    const std::string& local = context.names.input_local.at(i);
    if (on_demand(context, i)) {
        out.open(
            fmt::format("const etlmon::Lazy {}([&]() noexcept {{", context.names.flag_atom.at(i)));
        out.line(missed(fmt::format("!in.{}.present()", input.name)));
        print_recorded_flag(out, context, i, "in." + input.name);
        out.line("return etlmon::truth_of(in.{}{});", input.name, missing_flag(context, i));
        out.close("});");
        return;
    }
    if (input.hold == 0) {
        const std::string flag = "in." + input.name;
        print_flag_atom(out, context, i, flag);
        out.line(missed(fmt::format("!{}.present()", flag)));
        return print_recorded_flag(out, context, i, "in." + input.name);
    }
    const std::string& word = context.names.input_buffer.at(i);
    out.line("const uint32_t {} = in.{}.value();", word, input.name);
    print_wrapped(out, fmt::format("const uint32_t* const {} = {}.take(in.{}.present() ? &{} : "
                                   "nullptr);",
                                   local, context.names.hold_member.at(i), input.name, word));
    if (context.on_demand) {
        out.open(
            fmt::format("const etlmon::Lazy {}([&]() noexcept {{", context.names.flag_atom.at(i)));
        out.line(missed(local + " == nullptr"));
        print_recorded_flag(out, context, i, held_flag(local));
        print_wrapped(out, fmt::format("return etlmon::truth_of({}{});", held_flag(local),
                                       missing_flag(context, i)));
        out.close("});");
        return;
    }
    print_flag_atom(out, context, i, held_flag(local));
    out.line(missed(local + " == nullptr"));
    print_recorded_flag(out, context, i, held_flag(local));
}

void print_scalar(Printer& out, const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    const std::string& local = context.names.input_local.at(i);
    if (on_demand(context, i))
        print_wrapped(out, fmt::format("const etlmon::Lazy {}([&]() noexcept {{ return {}; }});",
                                       local, accepted(context, i)));
    else if (input.hold > 0)
        print_wrapped(out, fmt::format("const float {} = {}.take({});", local,
                                       context.names.hold_member.at(i), accepted(context, i)));
    else
        print_wrapped(out, fmt::format("const float {} = {};", local, accepted(context, i)));
}

/// Returns a pointer to the elements as float32, null if they are missing.
std::string elements(const Context& context, Index i) {
    return fmt::format("{} ? in.{}.data() : nullptr", present(context, i),
                       context.model.inputs[i].name);
}

void print_embedding_on_demand(Printer& out, const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    const std::string& local = context.names.input_local.at(i);
    if (!is_widened(input))
        return print_wrapped(
            out, fmt::format("const etlmon::Lazy {}([&]() noexcept {{ return {}; }});", local,
                             elements(context, i)));
    const std::string& buffer = context.names.input_buffer.at(i);
    out.line("float {}[{}];", buffer, input.dimension);
    out.open(fmt::format("const etlmon::Lazy {}([&]() noexcept -> const float* {{", local));
    print_wrapped(out, fmt::format("if (!{}) return nullptr;", present(context, i)));
    print_wrapped(out, widening(context, i));
    out.line("return {};", buffer);
    out.close("});");
}

void print_embedding(Printer& out, const Context& context, Index i) {
    if (on_demand(context, i)) return print_embedding_on_demand(out, context, i);
    const check::Input& input = context.model.inputs[i];
    const std::string& local = context.names.input_local.at(i);
    const bool held = input.hold > 0;
    if (is_widened(input))
        print_widened(out, context, i);
    else
        print_wrapped(out, fmt::format("const float* {}{} = {};", held ? "" : "const ", local,
                                       elements(context, i)));
    if (held) out.line("{} = {}.take({});", local, context.names.hold_member.at(i), local);
}

}  // namespace

std::string missed(const std::string& condition) {
    return fmt::format("missing = {} || missing;", condition);
}

std::string sample(const Context& context, Index i) {
    const check::Input& input = context.model.inputs[i];
    const auto local = context.names.input_local.find(i);
    if (local != context.names.input_local.end())
        return local->second + (on_demand(context, i) ? "()" : "");
    return input.type == InputType::scalar ? accepted(context, i) : "in." + input.name;
}

void print_input(Printer& out, const Context& context, Index i) {
    const auto direction = context.names.direction_local.find(i);
    if (direction != context.names.direction_local.end()) {
        const std::string& name = context.model.inputs[i].name;
        print_comment(out, "//", fmt::format("|{}|, shared by all distances that need it", name));
        out.line("const auto {} = etlmon::direction_of(in.{});", direction->second, name);
    }
    if (context.names.input_local.count(i) == 0) return;  // read in place
    switch (context.model.inputs[i].type) {
        case InputType::boolean: return print_flag(out, context, i);
        case InputType::scalar: return print_scalar(out, context, i);
        default: return print_embedding(out, context, i);
    }
}

}  // namespace etlc::emit
