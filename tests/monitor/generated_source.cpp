#include "generated_source.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace etlc::tests {
namespace {

using check::InputType;

const char* element_type(InputType type) {
    return type == InputType::f16 ? "uint16_t" : type == InputType::i8 ? "int8_t" : "float";
}

std::string members(const check::Model& model) {
    std::string result;
    for (const check::Input& input : model.inputs)
        result += fmt::format("  HARNESS_INPUT({});\n", input.name);
    for (const check::Predicate& predicate : model.predicates)
        if (!predicate.name.empty())
            result +=
                fmt::format("  HARNESS_{}PREDICATE({});\n",
                            predicate.threshold.adaptation ? "ADAPTIVE_" : "", predicate.name);
    return result;
}

std::string buffers(const check::Model& model) {
    std::string result = "  struct Buffers {\n";
    for (const check::Input& input : model.inputs)
        if (input.type != InputType::boolean)
            result += fmt::format("    {} {}[{}];\n", element_type(input.type), input.name,
                                  input.dimension);
    return result + "  };\n";
}

std::string feeding(const check::Model& model) {
    std::string result = "  static void feed(Inputs& in, Buffers& buffers) {\n    (void)buffers;\n";
    for (const check::Input& input : model.inputs) {
        const char* kind = input.type == InputType::scalar ? "scalar" : "vector";
        if (input.type == InputType::boolean)
            result += fmt::format("    harness::feed_flag<{}_input>(in);\n", input.name);
        else
            result += fmt::format("    harness::feed_{0}<{1}_input>(in, buffers.{1});\n", kind,
                                  input.name);
    }
    return result + "  }\n";
}

/// A class without delayed verdicts has no finish(), and none is called.
std::string finishing(const check::Model& model) {
    const bool waits = std::any_of(
        model.monitors.begin(), model.monitors.end(),
        [](const check::Monitor& monitor) { return monitor.sliding && monitor.horizon > 0; });
    return fmt::format("  static Verdicts finish(Monitor& m) {{ {} }}\n",
                       waits ? "return m.finish();" : "(void)m; return Verdicts{};");
}

std::string reporting(const check::Model& model) {
    std::string result = "  static void verdicts(const Verdicts& v) {\n";
    for (const check::Monitor& monitor : model.monitors)
        result += fmt::format("    harness::write_verdict(v.{});\n", monitor.name);
    result += "  }\n  static void telemetry(const Monitor& m) {\n    (void)m;\n";
    for (const check::Predicate& predicate : model.predicates)
        if (!predicate.name.empty())
            result +=
                fmt::format("    harness::write_telemetry<{0}_predicate>(m);\n{1}", predicate.name,
                            predicate.threshold.adaptation
                                ? fmt::format("    harness::write_threshold<{}_predicate>(m);\n",
                                              predicate.name)
                                : "");
    return result + "  }\n";
}

/// Passes labels of adaptive thresholds before a step, and resets them to the start.
std::string labelling(const check::Model& model) {
    std::string labels = "  static void labels(Monitor& m) {\n    (void)m;\n";
    std::string restart = "  static void restart(Monitor& m) {\n    (void)m;\n";
    for (const check::Predicate& predicate : model.predicates) {
        if (!predicate.threshold.adaptation) continue;
        labels += fmt::format("    harness::take_labels<{}_predicate>(m);\n", predicate.name);
        restart += fmt::format("    {}_predicate::restart(m, 0);\n", predicate.name);
    }
    return labels + "  }\n" + restart + "  }\n";
}

/// Calls restart_NAME() as restarts_before.hpp requires.
std::string restarting(const check::Model& model) {
    std::string result =
        "  static void restart_before(Monitor& m, uint32_t step) {\n    (void)m, (void)step;\n";
    for (std::size_t m = 0; m < model.monitors.size(); ++m)
        if (model.monitors[m].restarts != check::Restarts::never)
            result += fmt::format("    if (restarts_before(step, {})) m.restart_{}();\n", m,
                                  model.monitors[m].name);
    return result + "  }\n";
}

std::string explaining(const check::Model& model, bool explains) {
    std::string result = "  static void whys(const Monitor& m) {\n    (void)m;\n";
    for (const check::Monitor& monitor : model.monitors)
        if (explains) result += fmt::format("    harness::write_why(m.why_{}());\n", monitor.name);
    return result + "  }\n";
}

}  // namespace

std::string adaptor_source(const check::Model& model, bool explains, const std::string& session) {
    const std::string aliases = fmt::format(
        "  using Monitor = {0}::Monitor;\n"
        "  using Inputs = {0}::Inputs;\n"
        "  using Verdicts = {0}::Verdicts;\n",
        model.name);
    return fmt::format(
               "#include \"{0}.hpp\"\nnamespace {{\nstruct {0}_spec {{\n{1}}};\n}}  // namespace\n",
               model.name,
               aliases + members(model) + buffers(model) + feeding(model) + labelling(model) +
                   restarting(model) + reporting(model) + explaining(model, explains) +
                   finishing(model)) +
           fmt::format("void answer_{0}();\nvoid answer_{0}() {{ {1}<{0}_spec>::answer(); }}\n",
                       model.name, session);
}

std::string main_source(const std::vector<std::string>& specs) {
    std::string declarations;
    std::string table;
    for (const std::string& spec : specs) {
        declarations += fmt::format("void answer_{}();\n", spec);
        table += fmt::format("answer_{}, ", spec);
    }
    return fmt::format(
        "#include \"harness.hpp\"\n{}"
        "int main(int argc, char**) {{\n"
        "  const harness::Answer specs[] = {{{}}};\n"
        "  return harness::serve(specs, sizeof specs / sizeof *specs, argc);\n"
        "}}\n",
        declarations, table);
}

}  // namespace etlc::tests
