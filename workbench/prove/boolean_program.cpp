#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "emit/names.hpp"
#include "prove/boolean.hpp"
#include "prove/program.hpp"
#include "prove/text/cones.hpp"

namespace etlc::prove {
namespace {

constexpr std::uint32_t kNoLazy = 0xffffffffU;

/// Returns the names of the atoms in the class; empty for those that it does not read.
std::vector<std::string> names_of(const plan::Plan& plan, const std::vector<Atom>& atoms) {
    const emit::Names names = emit::make_names(plan);
    std::vector<std::string> result;
    for (const Atom& atom : atoms) {
        const auto& known = atom.is_predicate ? names.predicate_atom : names.flag_atom;
        const auto found = known.find(atom.index);
        result.push_back(!atom.is_read || found == known.end() ? "" : found->second);
    }
    return result;
}

/// Returns one target of the program, as its initialiser.
std::string target(const plan::Plan& plan, const Cones& cones, std::uint32_t m,
                   const std::vector<std::string>& atoms, bool may_freeze) {
    const plan::Monitor& monitor = plan.monitors[m];
    const std::string verdict = "answers_." + monitor.name;
    const auto local = emit::make_names(plan).open_local;
    const bool freezes = may_freeze && monitor.restarts == check::Restarts::never &&
                         local.contains(m) && cones.freezes(verdict, local.at(m));
    const Cones::Names cone = cones.of(verdict, freezes ? local.at(m) : "");
    std::vector<std::string> parts;
    for (const std::string& name : cone)
        if (name.ends_with("_") || name.starts_with("answers_."))
            parts.push_back(fmt::format("etlprove::part(monitor, monitor.{})", name));
    std::vector<bool> counts;
    for (const std::string& atom : atoms) counts.push_back(cone.contains(atom));
    std::vector<std::uint32_t> restarts;
    for (std::uint32_t other = 0; other < plan.monitors.size(); ++other)
        if (plan.monitors[other].restarts != check::Restarts::never &&
            cones.writes("restart_" + plan.monitors[other].name, cone))
            restarts.push_back(other);
    return fmt::format("        {{{}, {}, {}, {}, {{{}}}, {{{}}}, {{{}}}}},\n", m, !monitor.sliding,
                       monitor.restarts == check::Restarts::when_final, freezes,
                       fmt::join(parts, ", "), fmt::join(counts, ", "), fmt::join(restarts, ", "));
}

/// Whether an atom is missing at a step without samples: nothing of earlier steps stands in.
bool vanishes(const plan::Plan& plan, const emit::Names& names, const Atom& atom) {
    const check::Model& model = *plan.model;
    if (!atom.is_predicate) return model.inputs[atom.index].hold == 0;
    const auto& inputs = model.predicates[atom.index].inputs;
    return names.past_member.empty() && names.earlier_member.empty() && !inputs.empty() &&
           std::all_of(inputs.begin(), inputs.end(),
                       [&](const check::Index i) { return model.inputs[i].hold == 0; });
}

/// Returns an atom of the program, as its initialiser.
std::string atom_text(const plan::Plan& plan, const Atom& atom, Truths truths, std::uint32_t lazy) {
    const std::optional<bool> missing = atom.is_predicate
                                            ? plan.model->predicates[atom.index].missing
                                            : plan.model->inputs[atom.index].missing;
    return fmt::format("{{{}u, etlprove::Truths({}), {}, {}}}, ", lazy,
                       static_cast<std::uint32_t>(truths),
                       vanishes(plan, emit::make_names(plan), atom), missing.value_or(false));
}

}  // namespace

std::string text_of_truths() {
    constexpr std::string_view kLast = "bool high : 1;";
    for (const RuntimeFile& file : emit::runtime_files()) {
        std::string text(file.text);
        const std::size_t at = text.find(kLast);
        if (std::string_view(file.name) != "etlmon/temporal/truth.hpp" || at == std::string::npos)
            continue;
        return text.insert(at + kLast.size(), " uint8_t rest : 6;");
    }
    throw Unreadable{"no truth of two bits"};
}

std::uint32_t finishes_of(const plan::Plan& plan) {
    std::uint32_t calls = 0;
    for (const plan::Monitor& monitor : plan.monitors) calls = std::max(calls, monitor.horizon);
    return plan.has_sliding ? calls : 0;
}

etlprove::TruthPlaces truth_places(const plan::Plan& plan, const std::vector<Atom>& atoms,
                                   std::uint32_t steps) {
    return {steps + finishes_of(plan), static_cast<std::uint32_t>(atoms.size()),
            static_cast<std::uint32_t>(plan.monitors.size())};
}

std::string boolean_main(const plan::Plan& plan, const Request& request,
                         const std::vector<Atom>& atoms, const std::vector<Truths>& truths,
                         std::uint32_t steps, bool may_freeze) {
    const std::vector<std::string> names = names_of(plan, atoms);
    const Cones cones(request.header, {names.begin(), names.end()});
    std::string lazies;
    for (std::size_t a = 0; a < atoms.size(); ++a)
        lazies +=
            atom_text(plan, atoms[a], truths[a], names[a].empty() ? kNoLazy : cones.lazy(names[a]));
    std::string restarts;
    std::string targets;
    for (std::uint32_t m = 0; m < plan.monitors.size(); ++m) {
        targets += target(plan, cones, m, names, may_freeze);
        if (plan.monitors[m].restarts != check::Restarts::never)
            restarts +=
                fmt::format("    if (m == {}) monitor.restart_{}();\n", m, plan.monitors[m].name);
    }
    const etlprove::TruthPlaces places = truth_places(plan, atoms, steps);
    return fmt::format(
        "#include \"etlprove/cases.hpp\"\n#define private public\n#include \"class.hpp\"\n"
        "#undef private\n\nusing {0}::Monitor;\nusing {0}::Verdicts;\n\n"
        "static void restart(Monitor& monitor, uint32_t m) {{\n    (void)monitor, (void)m;\n{1}}}\n"
        "int main() {{\n    etlprove::end_with_etlc();\n    static Monitor monitor;\n"
        "    static_assert(sizeof(Verdicts) == {2}, \"a byte for each monitor\");\n"
        "    etlprove::choices().describe({{{3}}}, {{{4}, {5}, {6}}});\n"
        "    etlprove::CasesOf<Monitor> cases{{{7}, {8}, {10}, restart, {{\n{9}    }}}};\n"
        "    etlprove::Cases<Monitor, Verdicts>(cases).run();\n}}\n",
        request.name_space, restarts, plan.monitors.size(), lazies, places.steps, places.atoms,
        places.monitors, steps, finishes_of(plan), targets, request.most_cases);
}

}  // namespace etlc::prove
