// Prints drifts: whether new episodes still score like those of calibration.
#include "emit/context.hpp"

namespace etlc::emit {

namespace {

using check::Index;

std::string numbers(const float* begin, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = begin[i];
        const std::string number =
            std::isinf(x) ? (x < 0 ? "-etlmon::kInfinite" : "etlmon::kInfinite") : float_literal(x);
        text += (i > 0 ? ", " : "") + number;
    }
    return text;
}

}  // namespace

std::vector<Member> drift_members(const Context& context) {
    std::vector<Member> result;
    for (const auto& [d, names] : context.names.drifts)
        result.push_back({"etlmon::Drift", names.member,
                          fmt::format("scores since calibration; reset() keeps {}",
                                      "those of episodes that ended"),
                          names.member + ".begin();",
                          fmt::format("etlmon::Drift({})", names.cells)});
    return result;
}

void print_drift_interface(Printer& out, const Context& context) {
    if (context.names.drifts.empty()) return;
    print_doc(out,
              "Drifts. Call end_episode() after the last step of an episode that ended regularly, "
              "before reset(): only then its score counts, the greatest of its steps. reset() "
              "alone drops what was seen of an episode that was cut short. alarm_D() says that the "
              "episodes no longer score like those of calibration, so guarantees may not hold any "
              "more: find out what changed, and calibrate again. While nothing has changed it is "
              "ever raised with probability at most the level. It does not say that this episode "
              "failed, and its silence does not prove that nothing changed. An alarm stays. Save "
              "drift_D() and give it to set_drift_D() after a reboot, which returns false and "
              "changes nothing if that is no state of this calibration; "
              "set_drift_D(initial_drift_D()) begins again.");
    out.open("void end_episode() noexcept {");
    for (const auto& [d, names] : context.names.drifts)
        out.line("{}.end({});", names.member, names.cells);
    out.close();
    for (const auto& [d, names] : context.names.drifts) {
        const std::string& name = context.model.drifts[d].name;
        print_doc(out, context.place(context.model.drifts[d].span));
        print_wrapped(out, fmt::format("bool alarm_{}() const noexcept {{ return {}.alarm({}); }}",
                                       name, names.member, names.cells));
        print_wrapped(out, fmt::format("const etlmon::DriftState& drift_{}() const noexcept {{ "
                                       "return {}.state(); }}",
                                       name, names.member));
        out.open(
            fmt::format("bool set_drift_{}(const etlmon::DriftState& saved) noexcept {{", name));
        out.line("return {}.restore(saved, {});", names.member, names.cells);
        out.close();
        out.open(fmt::format("static constexpr etlmon::DriftState initial_drift_{}() noexcept {{",
                             name));
        out.line("return etlmon::Drift::first({});", names.cells);
        out.close();
    }
    out.line();
}

void print_drift_constants(Printer& out, const Context& context) {
    if (context.names.drifts.empty()) return;
    print_doc(out,
              "The scores of calibration in 8 cells: the scores between them and their random "
              "numbers, which decide between equal scores; the gaps in each cell; 1 / level.");
    for (const auto& [d, names] : context.names.drifts) {
        const etlmon::DriftCells& cells = context.model.drifts[d].cells;
        out.line("static constexpr etlmon::DriftCells {} = {{", names.cells);
        out.indent();
        print_wrapped(out, fmt::format("{{{}}},", numbers(cells.ends, etlmon::kDriftCells - 1)));
        print_wrapped(out, fmt::format("{{{:#010x}u}},", fmt::join(cells.draws, "u, ")));
        print_wrapped(out, fmt::format("{{{}}},", fmt::join(cells.gaps, ", ")));
        out.line("{}, {:#010x}u", float_literal(cells.limit), cells.id);
        out.close("};");
    }
    out.line();
}

void print_seen(Printer& out, const Context& context, Index predicate, const std::string& delta) {
    for (const auto& [d, names] : context.names.drifts)
        if (context.model.drifts[d].predicate == predicate)
            out.line("{}.see({}{});", names.member,
                     context.model.predicates[predicate].upper_bound() ? "" : "-", delta);
}

void print_seen_verdicts(Printer& out, const Context& context, std::string_view verdicts) {
    for (const auto& [d, names] : context.names.drifts)
        if (const Index monitor = context.model.drifts[d].monitor; monitor != check::kNone)
            out.line("{}.see(-{}.{}.upper);", names.member, verdicts,
                     context.model.monitors[monitor].name);
}

}  // namespace etlc::emit
