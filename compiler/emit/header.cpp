// The generated header, part by part in the order of the file.
#include <algorithm>
#include <set>

#include "emit/context.hpp"
#include "emit/emit.hpp"
#include "emit/standalone.hpp"
#include "plan/narrow_targets.hpp"
#include "plan/program/value_type.hpp"
#include "plan/stored.hpp"

namespace etlc::emit {

namespace {

using check::Index;
using check::InputType;
using plan::StreamOp;

std::string file_name(const std::string& path) {
    return path.substr(path.find_last_of('/') + 1);
}

// ---- includes

bool any_stream(const plan::Plan& plan, std::initializer_list<StreamOp> ops) {
    return std::any_of(plan.streams.begin(), plan.streams.end(), [&](const plan::Stream& stream) {
        return std::find(ops.begin(), ops.end(), stream.op) != ops.end();
    });
}

/// What measures a distance.
const char* header_of(const Context& context, Index d) {
    if (plan::stored_set(context.plan, d) == nullptr) return "distance/kernel";
    return plan::searches(context.plan, d) ? "distance/search" : "distance/targets";
}

std::set<std::string> runtime_headers(const Context& context) {
    const plan::Plan& plan = context.plan;
    const Spelling& words = context.spelling;
    std::set<std::string> headers{"scalars", "temporal/reading", "version"};
    headers.insert(words.predicates);
    headers.insert(words.verdicts);
    for (Index d : plan.distances) {
        headers.insert(header_of(context, d));
        if (context.enclosed(d)) headers.insert("distance/enclosed");
    }
    if (!context.names.point_local.empty()) headers.insert("distance/project");
    for (const auto& [projection, name] : context.names.matrix_array)
        if (plan::stored_projection(plan, projection) != nullptr)
            headers.insert("distance/targets");
    for (Index p : plan.predicates) {
        if (context.model.predicates[p].equality()) headers.insert("temporal/equality");
        if (!context.model.predicates[p].plain_distance()) headers.insert("temporal/expression");
        if (!plan::contrast_cuts(plan, context.model.predicates[p]).empty())
            headers.insert("distance/contrast");
    }
    if (!context.names.threshold_member.empty()) headers.insert("temporal/adaptation");
    for (Index i : plan.inputs) {
        const check::Input& input = context.model.inputs[i];
        if (input.type == InputType::f16 || input.type == InputType::i8)
            headers.insert("distance/widen");
        if (input.hold > 0) headers.insert("temporal/hold");
    }
    if (any_stream(plan, {StreamOp::delay, StreamOp::shift})) headers.insert(words.delays);
    if (std::any_of(plan.monitors.begin(), plan.monitors.end(),
                    [](const plan::Monitor& m) { return m.shifted; }))
        headers.insert("temporal/shift");
    if (any_stream(plan, {StreamOp::window, StreamOp::window_since, StreamOp::window_until}))
        headers.insert(words.windows);
    if (any_stream(plan, {StreamOp::window_handover}))
        headers.insert({"temporal/handover", "temporal/window"});
    if (any_stream(plan, {StreamOp::widening})) headers.insert("temporal/widening");
    if (plan.recorder) headers.insert("temporal/recorder");
    for (const Names::OfReading& reading : context.names.readings) {
        if (!reading.guards.empty()) headers.insert("temporal/machine");
        if (!reading.count.empty()) headers.insert("temporal/pending");
    }
    return headers;
}

void print_includes(Printer& out, const Context& context, const std::string& version,
                    bool standalone) {
    out.line("#pragma once");
    out.line();
    out.line("#include <stddef.h>");
    out.line("#include <stdint.h>");
    out.line();
    for (const std::string& header : runtime_headers(context))
        out.line("#include \"etlmon/{}.hpp\"", header);
    if (standalone && context.stores_targets()) {
        print_comment(out, "//", fmt::format("on a POSIX host, to map {}", context.targets_file));
        out.line("#if defined(ETLMON_MAPPED_TARGETS)");
        out.line("#include \"etlmon/hosted/mapped_targets.hpp\"");
        out.line("#endif");
    }
    const std::size_t dot = version.find('.');
    const std::string major = version.substr(0, dot);
    const std::string minor = version.substr(dot + 1, version.find('.', dot + 1) - dot - 1);
    out.line();
    out.line("#if ETLMON_VERSION_MAJOR != {} || ETLMON_VERSION_MINOR != {}", major, minor);
    out.line(
        "#error \"made by etlc {0}.{1}: run etlc again, or use the etlmon {0}.{1} that it was made "
        "for\"",
        major, minor);
    out.line("#endif");
    out.line();
}

}  // namespace

std::string header(const plan::Plan& plan, const Options& options) {
    const check::Model& model = *plan.model;
    const Context context{plan,
                          *plan.formulas,
                          model,
                          make_names(plan),
                          file_name(model.file.path()),
                          options.name_space.empty() ? model.name : options.name_space,
                          options.targets_file,
                          spelling(plan.values),
                          plan::value_type(plan.values).on_demand,
                          plan::dependents(plan)};
    Printer out;
    print_comment(out, "//",
                  fmt::format("Made by etlc {} from {}: change that, and run etlc again.",
                              options.version, context.spec_file));
    print_summary(out, context);
    print_includes(out, context, options.version, !options.standalone.empty());
    out.line("namespace {} {{", context.name_space);
    out.line(
        "inline namespace ETLMON_BUILD {  // units compiled with other flags have another class");
    out.line();
    print_inputs_and_verdicts(out, context);
    print_constants(out, context);
    print_tables(out, context);
    print_class(out, context);
    out.line("}  // namespace ETLMON_BUILD");
    out.line("}}  // namespace {}", context.name_space);
    return options.standalone.empty() ? out.take() : standalone(out.take(), options.standalone);
}

}  // namespace etlc::emit
