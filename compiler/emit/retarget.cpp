// Prints the parameters of a retargetable class: their offsets, and the calls that replace them.
#include "diag/diag.hpp"
#include "emit/context.hpp"
#include "plan/targets/kernels.hpp"

namespace etlc::emit {

namespace {

using check::Index;
using plan::Parameter;

/// Returns the namespace and the name of a parameter's offset.
std::pair<std::string_view, std::string> name_of(const Context& context, const Parameter& one) {
    switch (one.kind) {
        case Parameter::Kind::threshold:
            return {"thresholds", context.names.predicate_atom.at(one.index)};
        case Parameter::Kind::number:
        case Parameter::Kind::in_past:
            return {"constants", context.names.number_constant.at(one.number)};
        case Parameter::Kind::rows: return {"targets", context.names.target_array.at(one.index)};
        case Parameter::Kind::weights: return {"targets", context.names.weight_array.at(one.index)};
        case Parameter::Kind::matrix:
            return {"projections", context.names.matrix_array.at(one.index)};
        case Parameter::Kind::offset: break;
    }
    return {"projections", context.names.offset_array.at(one.index)};
}

std::string place_of(const Context& context, const Parameter& one) {
    const auto [space, name] = name_of(context, one);
    return fmt::format("{}::{}", space, name);
}

/// Returns "8 rows of 32 elements, scaled to length 1".
std::string words_for(const Context& context, const Parameter& one) {
    const check::Model& model = context.model;
    const std::string rows = fmt::format("{} of {}", diag::counted(one.count / one.width, "row"),
                                         diag::counted(one.width, "element"));
    switch (one.kind) {
        case Parameter::Kind::threshold: {
            if (one.count == 1) return "";
            const bool is_upper = model.predicates[one.index].upper_bound();
            return fmt::format("and the next: {}",
                               is_upper ? "true up to the first, false beyond the second"
                                        : "false below the first, true from the second on");
        }
        case Parameter::Kind::number:
            return "in the expression of " + model.predicates[one.index].name;
        case Parameter::Kind::in_past: return "in " + model.pasts[one.index].text;
        case Parameter::Kind::rows:
            return rows +
                   (plan::rows_as_given(model.distances[one.index]) ? "" : ", scaled to length 1");
        case Parameter::Kind::weights: return rows + ", of mahalanobis";
        case Parameter::Kind::matrix: return rows;
        case Parameter::Kind::offset: break;
    }
    return fmt::format("offset m of {}", model.projections[one.index].name);
}

std::string_view word_for(etlmon::ParamsPart::Rule rule) {
    switch (rule) {
        case etlmon::ParamsPart::any: break;
        case etlmon::ParamsPart::not_negative: return "not_negative";
        case etlmon::ParamsPart::positive: return "positive";
        case etlmon::ParamsPart::unit_rows: return "unit_rows";
        case etlmon::ParamsPart::symmetric: return "symmetric";
        case etlmon::ParamsPart::ascending: return "ascending";
    }
    return "any";
}

void print_places(Printer& out, const Context& context, std::string_view space,
                  const std::string& about) {
    std::vector<std::pair<std::string, std::string>> lines;
    for (const Parameter& one : context.parameters)
        if (const auto [in, name] = name_of(context, one); in == space)
            lines.emplace_back(fmt::format("inline constexpr size_t {} = {};", name, one.begin),
                               words_for(context, one));
    if (lines.empty()) return;
    print_doc(out, about);
    out.line("namespace {} {{", space);
    print_aligned(out, lines, "///<");
    out.line("}}  // namespace {}", space);
    out.line();
}

void print_layout(Printer& out, const Context& context) {
    print_doc(
        out,
        "The layout of a block of parameters. kShape is a hash of the class without its numbers; "
        "kEncoder is a hash of the encoder, 0 if the spec has none. A block must have both.");
    out.open("struct Layout {");
    out.line("static constexpr uint64_t kShape = 0x{:016x}u;", context.shape);
    out.line("static constexpr uint64_t kEncoder = 0x{:016x}u;",
             context.shape == 0 ? 0 : plan::encoder_hash(context.model));
    out.line("static constexpr size_t kSize = {};  ///< in bytes",
             plan::block_bytes(context.parameters));
    print_doc(out, "Offset, count, row length and rule of each part.");
    if (context.parameters.empty()) {
        out.line(
            "static constexpr etlmon::ParamsPart kParts[] = {{0, 0, 1, "
            "etlmon::ParamsPart::any}};");
    } else {
        out.open("static constexpr etlmon::ParamsPart kParts[] = {");
        for (const Parameter& one : context.parameters)
            out.line("{{{}, {}, {}, etlmon::ParamsPart::{}}}{}", place_of(context, one), one.count,
                     one.width, word_for(one.rule), &one == &context.parameters.back() ? "" : ",");
        out.close("};");
    }
    out.close("};");
}

}  // namespace

std::string Context::parameter(Parameter::Kind kind, Index index) const {
    for (const Parameter& one : parameters) {
        const bool is_same_array = kind == Parameter::Kind::rows &&
                                   one.kind == Parameter::Kind::rows &&
                                   names.target_array.at(one.index) == names.target_array.at(index);
        if (one.kind == kind && (one.index == index || is_same_array))
            return kind == Parameter::Kind::threshold
                       ? fmt::format("numbers_[{}]", place_of(*this, one))
                       : "numbers_ + " + place_of(*this, one);
    }
    return "";
}

std::string Context::threshold(Index predicate, bool inner) const {
    const bool of_two = model.predicates[predicate].threshold.inner.has_value();
    const bool is_second = of_two && inner != model.predicates[predicate].upper_bound();
    for (const Parameter& one : parameters)
        if (one.kind == Parameter::Kind::threshold && one.index == predicate)
            return fmt::format("numbers_[{}{}]", place_of(*this, one), is_second ? " + 1" : "");
    return "";
}

std::string Context::parameter(const check::Expr& number) const {
    return fmt::format("numbers_[constants::{}]", names.number_constant.at(&number));
}

std::string about_parameters(const plan::Plan& plan, bool is_calibrated) {
    return fmt::format(
        "Retargetable: target sets, thresholds and the numbers of projections, metrics and "
        "expressions are parameters, in a block of {} bytes. Besides state B, a monitor holds a "
        "pointer to its block, which may be replaced; above are the parameters of the spec. lower "
        "and upper hold for any parameters.{}",
        plan::block_bytes(plan::parameters(plan)),
        is_calibrated ? " A guarantee holds for the parameters that it was computed with." : "");
}

void print_parameters(Printer& out, const Context& context) {
    if (!context.retargetable()) return;
    const std::string from = "in floats from the start of the parameters";
    print_places(out, context, "thresholds", "Offsets of thresholds, " + from + ".");
    print_places(out, context, "constants", "Offsets of the numbers in expressions, likewise.");
    print_places(out, context, "targets", "Offsets of target sets, stored row by row.");
    print_places(out, context, "projections", "Offsets of projections A (z - m): of A and of m.");
    print_layout(out, context);
    print_doc(out,
              "A block of parameters, in flash or in memory, aligned to 64 bytes. The constructor "
              "reads all of it once to check it. It must not change while a monitor uses it.");
    out.line("using Params = etlmon::Params<Layout>;");
    out.line();
}

void print_retarget_interface(Printer& out, const Context& context) {
    if (!context.retargetable()) return;
    print_doc(out,
              "Has no parameters: every predicate and bool input is unknown at every step, until "
              "retarget() sets some.");
    out.line("constexpr Monitor() noexcept : numbers_(nullptr) { reset(); }");
    print_doc(out, "Uses the parameters if they are ready.");
    out.line("constexpr explicit Monitor(const Params& etlmon_params) noexcept");
    out.open("    : numbers_(etlmon_params.numbers()) {");
    out.line("reset();");
    out.close();
    print_doc(out, "Returns whether this monitor has parameters.");
    out.line("bool ready() const noexcept { return numbers_ != nullptr; }");
    print_doc(out, "Returns the hashes of what the parameters were made from.");
    out.line("etlmon::MadeFrom origin() const noexcept { return etlmon::made_from(numbers_); }");
    out.line();
    print_doc(
        out,
        "Replaces the parameters, from the next step on; call it between steps. If they are not "
        "ready, nothing changes and the result says why. Past::kept: verdicts go on, and steps "
        "keep the values measured with the old parameters. Past::forgotten: calls reset().");
    out.open("etlmon::ParamsState retarget(const Params& params, etlmon::Past past) noexcept {");
    print_wrapped(out, "if (!params.ready()) return params.state();");
    out.line("numbers_ = params.numbers();");
    print_wrapped(out, "if (past == etlmon::Past::forgotten) reset();");
    out.line("return params.state();");
    out.close();
    print_doc(out, "Replaces the parameters by those in the bytes of a block.");
    out.open(
        "etlmon::ParamsState retarget(const uint8_t* bytes, size_t size, etlmon::Past past) "
        "noexcept {");
    out.line("return retarget(Params(bytes, size), past);");
    out.close();
    out.line();
}

void print_unknown_atoms(Printer& out, const Context& context) {
    if (!context.retargetable()) return;
    print_doc(out, "Returns the atoms of a step without parameters.");
    out.open("Atoms unknown() noexcept {");
    out.line("Atoms now;");
    for (const auto* atoms : {&context.names.predicate_atom, &context.names.flag_atom})
        for (const auto& [index, name] : *atoms) out.line("now.{} = unseen();", name);
    print_wrapped(out, "if (incomplete_ != UINT32_MAX) ++incomplete_;");
    out.line("return now;");
    out.close();
    out.line();
}

void print_shadow(Printer& out, const Context& context) {
    if (!context.retargetable()) return;
    print_doc(out,
              "Two monitors side by side: one answers, the other tries out new parameters, and "
              "differences are counted (etlmon/params/shadow.hpp).");
    out.line("using Shadow = etlmon::Shadow<Monitor, Inputs, Verdicts, {}>;",
             context.plan.monitors.size());
    out.line();
}

}  // namespace etlc::emit
