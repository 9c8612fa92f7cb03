// Prints the generated header, in the order of the file.

#include <algorithm>
#include <set>

#include "data/files/hash.hpp"
#include "emit/context.hpp"
#include "emit/emit.hpp"
#include "emit/standalone.hpp"
#include "emit/text/identifiers.hpp"
#include "plan/program/value_type.hpp"
#include "plan/targets/narrow_targets.hpp"
#include "plan/targets/stored.hpp"

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

/// Returns the runtime header that measures a distance.
const char* header_of(const Context& context, Index d) {
    if (context.retargetable()) return "params/rows";
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
    for (const auto& [point, local] : context.names.point_local)
        headers.insert(context.model.points[point].is_projected() ? "distance/project"
                                                                  : "distance/between");
    for (const Index d : plan.distances)
        if (context.model.distances[d].is_between_points()) headers.insert("distance/between");
    if (!context.names.earlier_member.empty()) headers.insert("past/points");
    for (const auto& [projection, name] : context.names.matrix_array)
        if (plan::stored_projection(plan, projection) != nullptr)
            headers.insert("distance/targets");
    for (Index p : plan.predicates) {
        if (context.model.predicates[p].equality()) headers.insert("temporal/equality");
        if (!context.model.predicates[p].plain_distance()) headers.insert("temporal/expression");
        if (!plan::contrast_cuts(plan, context.model.predicates[p]).empty())
            headers.insert("distance/contrast");
    }
    if (!plan.pasts.empty()) headers.insert("past/numbers");
    if (!context.names.threshold_member.empty()) headers.insert("temporal/adaptation");
    if (!context.names.drifts.empty()) headers.insert("temporal/drift");
    for (Index i : plan.inputs) {
        const check::Input& input = context.model.inputs[i];
        if (input.type == InputType::f16 || input.type == InputType::i8)
            headers.insert("distance/widen");
        if (input.hold > 0) headers.insert("temporal/hold");
        if (input.stale_after > 0) headers.insert("temporal/stale");
    }
    if (any_stream(plan, {StreamOp::delay, StreamOp::shift})) headers.insert(words.delays);
    if (std::any_of(plan.monitors.begin(), plan.monitors.end(),
                    [](const plan::Monitor& m) { return m.shifted; }))
        headers.insert("temporal/shift");
    if (any_stream(plan, {StreamOp::window, StreamOp::window_since, StreamOp::window_until}))
        headers.insert(words.windows);
    if (any_stream(plan, {StreamOp::window_count})) headers.insert("past/count");
    if (any_stream(plan, {StreamOp::window_handover}))
        headers.insert({"temporal/handover", "temporal/window"});
    if (any_stream(plan, {StreamOp::widening})) headers.insert("temporal/widening");
    if (plan.recorder) headers.insert("temporal/recorder");
    if (has_references(context)) headers.insert("reference");
    if (context.retargetable()) headers.insert({"params/params", "params/shadow"});
    for (const Names::OfReading& reading : context.names.readings) {
        if (!reading.guards.empty()) headers.insert("temporal/machine");
        if (!reading.count.empty()) headers.insert("temporal/pending");
        if (std::count(reading.elements.begin(), reading.elements.end(), 0) > 0)
            headers.insert("temporal/registers");
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
        print_comment(out, "//", fmt::format("Maps {} on a POSIX host.", context.targets_file));
        out.line("#if defined(ETLMON_MAPPED_TARGETS)");
        out.line("#include \"etlmon/hosted/mapped_targets.hpp\"");
        out.line("#endif");
    }
    const std::size_t dot = version.find('.');
    const std::string major = version.substr(0, dot);
    const std::string minor = version.substr(dot + 1, version.find('.', dot + 1) - dot - 1);
    out.line();
    out.line("#if ETLMON_VERSION_MAJOR != {} || ETLMON_VERSION_MINOR != {}", major, minor);
    out.line("#error \"generated by etlc {0}.{1}: run etlc again, or use etlmon {0}.{1}\"", major,
             minor);
    out.line("#endif");
    out.line();
}

Context context_of(const plan::Plan& plan, const Options& options) {
    const check::Model& model = *plan.model;
    Context context{plan,
                    *plan.formulas,
                    model,
                    make_names(plan),
                    file_name(model.file.path()),
                    options.name_space.empty() ? model.name : options.name_space,
                    options.targets_file,
                    spelling(plan.values),
                    plan::value_type(plan.values).on_demand,
                    plan::dependents(plan)};
    if (model.retargetable) context.parameters = plan::parameters(plan);
    return context;
}

/// Prints the contents of the namespace.
void print_body(Printer& out, const Context& context) {
    print_inputs_and_verdicts(out, context);
    if (context.retargetable())
        print_parameters(out, context);
    else
        print_constants(out, context);
    print_references(out, context);
    print_tables(out, context);
    print_class(out, context);
    print_shadow(out, context);
}

/// Removes the comments of a program. No string of generated code contains two slashes.
std::string without_comments(std::string_view text) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = text.substr(at, end - at);
        const std::string_view code = line.substr(0, line.find("//"));
        const std::size_t last = code.find_last_not_of(' ');
        if (last != code.npos) result.append(code.substr(0, last + 1)).push_back('\n');
        at = end + 1;
    }
    return result;
}

/// Returns XXH64 of the text of the class without the numbers of the spec, whatever its namespace,
/// with 0 for the hashes of the parameters.
std::uint64_t shape(const plan::Plan& plan, const std::string& version) {
    Options options;
    options.version = version;
    Context context = context_of(plan, options);
    context.with_references = false;
    Printer out;
    print_includes(out, context, version, false);
    print_body(out, context);
    return data::xxh64(without_comments(out.take()));
}

/// The inline namespace of one text, while its digest is not known yet.
constexpr std::string_view kOfText = "text_0000000000000000";

/// Puts the digest of the header's code into the name of its namespace, so that no two headers have
/// different inline functions or variables of one name: the linker would keep only one of them.
/// Comments do not count: the numbers of a retargetable class stand in no other place.
std::string with_digest(std::string text) {
    const std::string name = fmt::format("text_{:016x}", data::xxh64(without_comments(text)));
    for (const std::string_view before : {"\ninline namespace ", "\n}  // namespace "}) {
        const std::size_t at = text.find(fmt::format("{}{}", before, kOfText));
        text.replace(at + before.size(), kOfText.size(), name);
    }
    return text;
}

}  // namespace

std::string header(const plan::Plan& plan, const Options& options) {
    Context context = context_of(plan, options);
    if (context.retargetable()) context.shape = shape(plan, options.version);
    Printer out;
    print_comment(
        out, "//",
        fmt::format(
            "Generated by etlc {} from {}. Do not edit: change the spec and run etlc again.",
            options.version, context.spec_file));
    print_summary(out, context);
    print_includes(out, context, options.version, !options.standalone.empty());
    Printer inner;
    inner.line("namespace {} {{", context.name_space);
    inner.line("// One program may hold several headers of this name, and units with other flags:");
    inner.line("// each has a class of its own.");
    inner.line("inline namespace ETLMON_BUILD {");
    inner.line("inline namespace {} {{", kOfText);
    inner.line();
    print_body(inner, context);
    inner.line("}}  // namespace {}", kOfText);
    inner.line("}  // namespace ETLMON_BUILD");
    inner.line("}}  // namespace {}", context.name_space);
    const std::string text = out.take() + shielded(inner.take());
    return with_digest(options.standalone.empty() ? text : standalone(text, options.standalone));
}

std::string params(const plan::Plan& plan, const Options& options) {
    return plan::block(plan, shape(plan, options.version));
}

const std::vector<Backend>& backends() {
    static const std::vector<Backend> table = {
        {"hpp", "the monitor class (what -o writes)", header},
        {"params", "the parameters that a class of --retargetable takes, as bytes", params},
        {"dot", "the formulas as a Graphviz graph", dot},
        {"report", "the budget: state, constants, code, work, horizon, per monitor", report},
    };
    return table;
}

}  // namespace etlc::emit
