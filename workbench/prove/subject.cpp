// Writes the program around a class: what the class has, by the names that etlc gave it. Keeps
// true: nothing here is read from the text of the class but which files of the runtime it includes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "emit/names.hpp"
#include "prove/program.hpp"
#include "prove/subject.hpp"

namespace etlc::prove {
namespace {

/// Returns the lines that include files of the runtime.
std::string includes_of(const std::string& header) {
    constexpr std::string_view kInclude = "#include \"etlmon/";
    std::string lines;
    for (std::size_t at = 0; at < header.size();) {
        const std::size_t end = std::min(header.find('\n', at), header.size());
        const std::string_view line = std::string_view(header).substr(at, end - at);
        if (line.starts_with(kInclude)) lines.append(line) += '\n';
        at = end + 1;
    }
    return lines;
}

/// The text of the functions of a Subject, which stand_in/etlprove/calls.hpp uses.
class Writer {
public:
    Writer(const plan::Plan& plan, const Request& request, const std::vector<Atom>& atoms)
        : plan_(plan), request_(request), atoms_(atoms), names_(emit::make_names(plan)) {}

    std::string subject() const {
        const bool boolean = plan_.values == check::Values::boolean;
        std::string text = fmt::format(
            "struct Subject {{\n    using Monitor = {0}::Monitor;\n"
            "    using Verdicts = {0}::Verdicts;\n"
            "    static constexpr uint32_t kMonitors = {1};\n"
            "    static constexpr bool kRepeats = {2}, kMeasures = {3};\n"
            "    static void construct(void* at) {{ new (at) Monitor({4}); }}\n"
            "    static Verdicts step(Monitor& monitor) {{ return monitor.step({{}}); }}\n"
            "    static Verdicts finish(Monitor& monitor) {{ return {5}; }}\n",
            request_.name_space, plan_.monitors.size(), repeats(), !plan_.model->retargetable,
            constructor_arguments(plan_),
            plan_.has_sliding ? "monitor.finish()" : "(void)monitor, Verdicts()");
        text += boolean ? "    static Verdicts judge(Monitor& monitor) { return step(monitor); }\n"
                          "    static bool measures(Monitor&) { return true; }\n"
                        : halves();
        return text + restarts() + answers() + telemetry() + "};\n";
    }

    /// Returns the atoms in the order in which a step asks for them.
    std::string order(const std::vector<Truths>& truths) const {
        std::vector<std::string> all;
        const auto add = [&](bool is_predicate, check::Index index) {
            for (std::size_t a = 0; a < atoms_.size(); ++a)
                if (atoms_[a].is_read && atoms_[a].is_predicate == is_predicate &&
                    atoms_[a].index == index)
                    all.push_back(fmt::format("{{{}, etlprove::Truths({}), {}, {}}}", a,
                                              truths.empty() ? 0 : static_cast<int>(truths[a]),
                                              vanishes(atoms_[a]), missing(atoms_[a])));
        };
        for (const check::Index input : plan_.inputs) add(false, input);
        for (const check::Index predicate : plan_.predicates) add(true, predicate);
        return fmt::format("{}", fmt::join(all, ", "));
    }

private:
    const plan::Plan& plan_;
    const Request& request_;
    const std::vector<Atom>& atoms_;
    const emit::Names names_;

    bool repeats() const { return !names_.alarms_member.empty(); }

    /// Returns one line for each monitor.
    template <class Line>
    std::string for_each(const Line& line) const {
        std::string text;
        for (std::uint32_t m = 0; m < plan_.monitors.size(); ++m) text += line(m);
        return text;
    }

    std::string name_of(const Atom& atom) const {
        return (atom.is_predicate ? names_.predicate_atom : names_.flag_atom).at(atom.index);
    }

    /// The two halves of a step. An atom is found by its name.
    std::string halves() const {
        std::string set, same;
        for (std::size_t a = 0; a < atoms_.size(); ++a) {
            if (!atoms_[a].is_read) continue;
            set += fmt::format("        now.{} = Value(etlprove::samples().value({}));\n",
                               name_of(atoms_[a]), a);
            same += fmt::format(" &&\n            is(now.{}, {})", name_of(atoms_[a]), a);
        }
        return fmt::format(
            "    using Value = Monitor::Value;\n"
            "    static Verdicts judge(Monitor& monitor) {{\n        Monitor::Atoms now{{}};\n{}"
            "        return monitor.judge(now);\n    }}\n"
            "    static bool measures(Monitor& monitor) {{\n"
            "        const Monitor::Atoms now = monitor.measure({{}});\n"
            "        const auto is = [](Value found, uint32_t atom) {{\n"
            "            const Value expected = etlprove::samples().value(atom);\n"
            "            return memcmp(&found, &expected, sizeof found) == 0;\n        }};\n"
            "        (void)now, (void)is;\n        return true{};\n    }}\n",
            set, same);
    }

    std::string restarts() const {
        const auto is = [&](const char* name, const auto& holds) {
            return fmt::format(
                "    static bool {}(uint32_t m) {{\n        (void)m;\n{}"
                "        return false;\n    }}\n",
                name, for_each([&](std::uint32_t m) {
                    return holds(m) ? fmt::format("        if (m == {}) return true;\n", m)
                                    : std::string();
                }));
        };
        const auto restarts = [&](std::uint32_t m) {
            return plan_.monitors[m].restarts != check::Restarts::never;
        };
        const auto repeats = [&](std::uint32_t m) { return names_.alarms_member.contains(m); };
        std::string text = is("restarts", restarts) + is("repeats", repeats);
        text +=
            "    static void restart(Monitor& monitor, uint32_t m) {\n        (void)monitor, "
            "(void)m;\n";
        text += for_each([&](std::uint32_t m) {
            return restarts(m) ? fmt::format("        if (m == {}) monitor.restart_{}();\n", m,
                                             plan_.monitors[m].name)
                               : std::string();
        });
        text +=
            "    }\n    static std::pair<uint32_t, uint32_t> counts(const Monitor& monitor, "
            "uint32_t m) {\n        (void)monitor, (void)m;\n";
        text += for_each([&](std::uint32_t m) {
            return repeats(m) ? fmt::format(
                                    "        if (m == {0}) return {{monitor.alarms_{1}(), "
                                    "monitor.fulfilled_{1}()}};\n",
                                    m, plan_.monitors[m].name)
                              : std::string();
        });
        return text + "        return {0, 0};\n    }\n";
    }

    /// The verdicts, by their names.
    std::string answers() const {
        std::vector<std::string> names;
        for (const plan::Monitor& monitor : plan_.monitors)
            names.push_back('"' + monitor.name + '"');
        return fmt::format(
            "    static auto of(const Verdicts& verdicts, uint32_t m) {{\n{}"
            "        return &verdicts.{};\n    }}\n"
            "    static etlprove::Answer answer(const Verdicts& verdicts, uint32_t m) {{\n"
            "        return etlprove::answer_of(*of(verdicts, m));\n    }}\n"
            "    static bool is_named(const Verdicts& verdicts) {{\n"
            "        static const char* const names[] = {{{}}};\n"
            "        uint32_t m = 0;\n"
            "        for (const auto& [name, verdict] : named(verdicts)) {{\n"
            "            if (m == kMonitors || strcmp(name, names[m]) != 0) return false;\n"
            "            if (memcmp(&verdict, of(verdicts, m++), sizeof verdict) != 0) return "
            "false;\n"
            "        }}\n        return m == kMonitors;\n    }}\n",
            for_each([&](std::uint32_t m) {
                return fmt::format("        if (m == {}) return &verdicts.{};\n", m,
                                   plan_.monitors[m].name);
            }),
            plan_.monitors[0].name, fmt::join(names, ", "));
    }

    /// Members that no verdict depends on, and the windows over pairs.
    std::string telemetry() const {
        std::vector<std::string> members{"&monitor.incomplete_"};
        for (const auto* const names : {&names_.alarms_member, &names_.fulfilled_member})
            for (const auto& [m, name] : *names) members.push_back("&monitor." + name);
        std::string text = fmt::format(
            "    static std::vector<const void*> telemetry(const Monitor& monitor) {{\n"
            "        return {{{}}};\n    }}\n"
            "    static std::vector<etlprove::WindowOfClass> windows(const Monitor& monitor) {{\n"
            "        (void)monitor;\n        std::vector<etlprove::WindowOfClass> all;\n",
            fmt::join(members, ", "));
        for (const emit::Names::OfStream& stream : names_.streams)
            if (!stream.member.empty())
                text +=
                    fmt::format("        etlprove::add_window(all, monitor.{});\n", stream.member);
        return text + "        return all;\n    }\n";
    }

    /// Whether an atom is missing at a step without samples: nothing of earlier steps stands in.
    bool vanishes(const Atom& atom) const {
        const check::Model& model = *plan_.model;
        if (!atom.is_predicate) return model.inputs[atom.index].hold == 0;
        const auto& inputs = model.predicates[atom.index].inputs;
        return names_.past_member.empty() && names_.earlier_member.empty() && !inputs.empty() &&
               std::all_of(inputs.begin(), inputs.end(),
                           [&](const check::Index i) { return model.inputs[i].hold == 0; });
    }
    bool missing(const Atom& atom) const {
        const std::optional<bool> missing = atom.is_predicate
                                                ? plan_.model->predicates[atom.index].missing
                                                : plan_.model->inputs[atom.index].missing;
        return missing.value_or(false);
    }
};

}  // namespace

std::string constructor_arguments(const plan::Plan& plan) {
    return plan.stored.empty() || plan.model->retargetable ? "" : "nullptr, 0";
}

std::string program_text(const plan::Plan& plan, const Request& request,
                         const std::vector<Atom>& atoms, const std::vector<Truths>& truths) {
    const Writer writer(plan, request, atoms);
    const bool boolean = plan.values == check::Values::boolean;
    return fmt::format(
        "#include \"etlprove/driver.hpp\"\n{0}\n#define private public\n"
        "#define static_assert(...) static_assert(true, \"\")\n"
        "#define uint32_t etlprove::Word\n{1}#include \"class.hpp\"\n{2}#undef uint32_t\n"
        "#undef static_assert\n#undef private\n\n{3}\n"
        "int main(int count, char** words) {{\n    etlprove::end_with_etlc();\n"
        "    etlprove::are_truths() = {4};\n    etlprove::recorded().is = {5};\n"
        "    etlprove::take_numbers(count - 2, words + 2);\n"
        "    etlprove::ways().set_most({6});\n"
        "    const uint32_t steps = static_cast<uint32_t>(atoi(words[1]));\n"
        "    etlprove::samples().describe({{{7}}}, {8}, steps + {9});\n"
        "    etlprove::Driver<Subject>({{steps, {9}, {10}}}).run();\n}}\n",
        includes_of(request.header), boolean ? "#define bool etlprove::Bit\n" : "",
        boolean ? "#undef bool\n" : "", writer.subject(), boolean, plan.recorder.has_value(),
        request.most_ways, writer.order(truths), atoms.size(), finishes_of(plan),
        request.most_together);
}

std::string object_text(const plan::Plan& plan, const Request& request) {
    const auto for_each = [&](const char* text, const auto& has) {
        std::string lines;
        for (const plan::Monitor& monitor : plan.monitors)
            if (has(monitor)) lines += fmt::format(fmt::runtime(text), monitor.name);
        return lines;
    };
    const bool has_pointer = !plan.stored.empty() || plan.model->retargetable;
    return fmt::format(
        "#include <new>\n#include \"class.hpp\"\n\nusing {0}::Monitor;\n"
        "static_assert(sizeof(Monitor) == {1}, \"the state is as planned\");\n"
        "void uses(void* at, const {0}::Inputs& in, {0}::Verdicts& verdicts) {{\n"
        "    Monitor& monitor = *new (at) Monitor({2});\n    monitor.reset();\n"
        "    verdicts = monitor.step(in);\n{3}{4}    (void)named(verdicts);\n}}\n",
        request.name_space,
        has_pointer ? fmt::format("etlmon::with_pointer({})", plan.cost.state_bytes)
                    : fmt::format("{}", plan.cost.state_bytes),
        constructor_arguments(plan), plan.has_sliding ? "    verdicts = monitor.finish();\n" : "",
        for_each("    monitor.restart_{}();\n", [](const plan::Monitor& monitor) {
            return monitor.restarts != check::Restarts::never;
        }));
}

}  // namespace etlc::prove
