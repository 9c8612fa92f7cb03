#include "compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace etlc::tests {
namespace {

using reference::Status;
using reference::Verdict;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const char* word(Status status) {
    switch (status) {
        case Status::satisfied: return "satisfied";
        case Status::violated: return "violated";
        case Status::unknown: return "unknown";
        case Status::undecided: return "undecided";
    }
    return "?";
}

std::string show(const Verdict& v) {
    return fmt::format("[{:.9g}, {:.9g}, {:.9g}] {} final {}", v.lower, v.robustness, v.upper,
                       word(v.status), v.final);
}

class Judge {
public:
    Judge(const check::Model& model, const reference::Run& expected, const Observed& observed,
          Comparison comparison)
        : model_(model),
          expected_(expected),
          observed_(observed),
          rounding_(comparison.rounding),
          on_demand_(comparison.on_demand) {}

    std::optional<std::string> judge() {
        if (auto bad = rows("step", expected_.verdicts, observed_.verdicts)) return bad;
        if (auto bad = positions()) return bad;
        if (auto bad = rows("finish call", expected_.finish, observed_.finish)) return bad;
        if (auto bad = later_values()) return bad;
        if (auto bad = telemetry()) return bad;
        const std::uint32_t expected = missing_steps();
        if (on_demand_ ? observed_.missing_steps > expected : observed_.missing_steps != expected)
            return fmt::format("missing_steps {}, expected {}", observed_.missing_steps, expected);
        return {};
    }

private:
    std::string monitor(std::size_t m) const {
        const check::Monitor& monitor = model_.monitors[m];
        return fmt::format("{} = {}", monitor.name, check::print(model_, monitor.formula));
    }

    using Rows = std::vector<std::vector<Verdict>>;

    const check::Model& model_;
    const reference::Run& expected_;
    const Observed& observed_;
    double rounding_;
    bool on_demand_;

    double slack(double value) const {
        return std::isfinite(value) ? rounding_ * std::max(1.0, std::abs(value)) : 0;
    }
    bool equal(double a, double b) const { return a == b || std::abs(a - b) <= slack(b); }
    bool at_most(double a, double b) const { return a <= b + slack(b); }
    /// A sign that rounding may change.
    bool near_zero(double value) const { return rounding_ > 0 && std::abs(value) <= rounding_; }

    std::optional<std::string> rows(const char* what, const Rows& expected,
                                    const Rows& observed) const {
        if (expected.size() != observed.size())
            return fmt::format("{} rows of kind '{}', expected {}", observed.size(), what,
                               expected.size());
        for (std::size_t row = 0; row < expected.size(); ++row)
            for (std::size_t m = 0; m < model_.monitors.size(); ++m)
                if (const char* bad =
                        verdict(expected[row][m], observed[row][m], model_.monitors[m].sliding))
                    return fmt::format("{} {} of {}: {} differs: {}, expected {}", what, row,
                                       monitor(m), bad, show(observed[row][m]),
                                       show(expected[row][m]));
        return {};
    }

    std::optional<std::string> positions() const {
        for (std::size_t step = 0; step < observed_.positions.size(); ++step)
            for (std::size_t m = 0; m < model_.monitors.size(); ++m) {
                const std::uint64_t expected = expected_.positions[step][m];
                const std::uint64_t observed = observed_.positions[step][m];
                if (expected_.verdicts[step][m].status != Status::undecided && observed != expected)
                    return fmt::format("step {} of {}: about position {}, expected {}", step,
                                       monitor(m), observed, expected);
            }
        return {};
    }

    /// Returns the difference, or null.
    const char* verdict(const Verdict& e, const Verdict& o, bool sliding) const {
        if ((e.status == Status::undecided) != (o.status == Status::undecided)) return "decided";
        if (e.status == Status::undecided) return o.final ? "final" : nullptr;
        if (!equal(o.robustness, e.robustness)) return "robustness";
        if (o.status != e.status && !near_zero(e.robustness) && !near_zero(e.robustness_high))
            return "status";
        if (sliding) {
            if (!equal(o.lower, e.lower)) return "lower";
            if (!equal(o.upper, e.upper)) return "upper";
            return o.final ? nullptr : "final";
        }
        // "They must be sound, and at least as tight as this definition."
        if (!at_most(e.lower, o.lower) || !at_most(o.lower, e.robustness)) return "lower";
        if (!at_most(o.upper, e.upper) || !at_most(e.robustness, o.upper)) return "upper";
        const bool complete = e.final && !(e.lower >= 0 || e.upper < 0);
        if (o.final != (o.lower >= 0 || o.upper < 0 || complete)) return "final";
        return nullptr;
    }

    /// The bounds hold for rho at every later step of this trace with the same position.
    std::optional<std::string> later_values() const {
        for (std::size_t m = 0; m < model_.monitors.size(); ++m) {
            if (model_.monitors[m].sliding) continue;
            double least = kInfinity;
            double most = -kInfinity;
            for (std::size_t step = expected_.verdicts.size(); step-- > 0;) {
                const Verdict& o = observed_.verdicts[step][m];
                const bool last = step + 1 == expected_.verdicts.size() ||
                                  expected_.positions[step + 1][m] != expected_.positions[step][m];
                if (last) {
                    least = kInfinity;
                    most = -kInfinity;
                }
                least = std::min(least, expected_.verdicts[step][m].robustness);
                most = std::max(most, expected_.verdicts[step][m].robustness_high);
                if (!at_most(o.lower, least) || !at_most(most, o.upper))
                    return fmt::format(
                        "step {} of {}: {} does not bound what follows, [{:.9g}, {:.9g}]", step,
                        monitor(m), show(o), least, most);
            }
        }
        return {};
    }

    std::uint32_t missing_steps() const {
        std::uint32_t result = 0;
        for (std::size_t step = 0; step < expected_.telemetry.size(); ++step) {
            bool lacking = false;
            for (std::size_t p = 0; p < model_.predicates.size(); ++p)
                lacking |= observed_.dependencies.predicates[p] &&
                           std::isnan(expected_.telemetry[step][p].delta);
            for (std::size_t n = 0; n < model_.inputs.size(); ++n)
                lacking |= observed_.dependencies.flags[n] && !expected_.present[step][n];
            if (lacking) ++result;
        }
        return result;
    }

    std::optional<std::string> telemetry() const {
        for (std::size_t step = 0; step < observed_.telemetry.size(); ++step)
            for (std::size_t p = 0; p < model_.predicates.size(); ++p) {
                const Observed::Predicate& o = observed_.telemetry[step][p];
                const reference::Telemetry& e = expected_.telemetry[step][p];
                if (!o.computed || (on_demand_ && std::isnan(o.delta))) continue;
                const std::string at =
                    fmt::format("step {} of predicate {}", step, model_.predicates[p].name);
                if (std::isnan(o.delta) != std::isnan(e.delta) ||
                    (!std::isnan(e.delta) && !equal(o.delta, e.delta)))
                    return fmt::format("{}: distance {:.9g}, expected {:.9g}", at, o.delta,
                                       e.delta);
                // Rounding may make another row the nearest; exact ties go to the first row.
                if (o.nearest && !std::isnan(e.delta) && rounding_ == 0 && *o.nearest != e.nearest)
                    return fmt::format("{}: nearest row {}, expected {}", at, *o.nearest,
                                       e.nearest);
            }
        return {};
    }
};

}  // namespace

std::optional<std::string> first_mismatch(const check::Model& model, const reference::Run& expected,
                                          const Observed& observed, const Comparison& comparison) {
    return Judge(model, expected, observed, comparison).judge();
}

}  // namespace etlc::tests
