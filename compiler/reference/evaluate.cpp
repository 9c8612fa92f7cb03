#include <algorithm>
#include <cmath>
#include <utility>

#include "reference/atoms.hpp"
#include "reference/clauses.hpp"
#include "reference/explanation.hpp"
#include "reference/normal_form.hpp"
#include "reference/prefix.hpp"
#include "reference/reference.hpp"

namespace etlc::reference {
namespace {

using check::Values;

bool holds(const check::Predicate& predicate, double delta, double epsilon) {
    switch (predicate.comparison) {
        case check::Comparison::less_equal: return delta <= epsilon;
        case check::Comparison::less: return delta < epsilon;
        case check::Comparison::greater_equal: return delta >= epsilon;
        case check::Comparison::greater: return delta > epsilon;
        case check::Comparison::equal: return delta == epsilon;
        case check::Comparison::not_equal: return delta != epsilon;
    }
    return false;
}

double truth(bool holds) {
    return holds ? kInfinity : -kInfinity;
}

/// Returns whether a comparison holds for all values in the ranges of its sides, and whether for
/// any.
std::pair<bool, bool> answers(const check::Predicate& predicate) {
    const check::Range& deltas = predicate.delta;
    const check::Range thresholds = predicate.threshold.range();
    if (predicate.equality()) {
        const bool can_be_equal = deltas.low <= thresholds.high && thresholds.low <= deltas.high;
        const bool must_be_equal = deltas.low == deltas.high && thresholds.low == deltas.low &&
                                   thresholds.high == deltas.low;
        if (predicate.comparison == check::Comparison::equal) return {must_be_equal, can_be_equal};
        return {!can_be_equal, !must_be_equal};
    }
    bool always = true;
    bool ever = false;
    for (const double delta : {deltas.low, deltas.high})  // an order changes at most once
        for (const double epsilon : {thresholds.low, thresholds.high}) {
            always = always && holds(predicate, delta, epsilon);
            ever = ever || holds(predicate, delta, epsilon);
        }
    return {always, ever};
}

/// "for a predicate its range [...]"; "a bool has robustness +inf or -inf".
Unseen range_of(const check::Model& model, const Node& atom, Values values) {
    Unseen range{-kInfinity, kInfinity};
    if (atom.kind == Node::Kind::predicate) {
        const check::Predicate& predicate = model.predicates[atom.index];
        range = {predicate.robustness.low, predicate.robustness.high};
        if (values == Values::boolean || predicate.equality()) {
            const auto [always, ever] = answers(predicate);
            range = {truth(always), truth(ever)};
        }
        // "of a predicate that counts as false where it is missing, the lowest is -inf"
        if (predicate.missing == false) range.lowest = -kInfinity;
        if (predicate.missing == true) range.highest = kInfinity;
    }
    return atom.negated ? negate(range) : range;
}

/// The lowest and highest rho of an atom: one number, except between two thresholds.
struct Ends {
    double low = 0;
    double high = 0;
};

/// "epsilon - delta or delta - epsilon"; "an infinite threshold: nothing is beyond it".
double beside(const check::Predicate& predicate, double delta, double epsilon) {
    if (std::isinf(epsilon)) return predicate.upper_bound() ? epsilon : -epsilon;
    return predicate.upper_bound() ? epsilon - delta : delta - epsilon;
}

/// "== and != are +inf or -inf"; with Boolean values the comparison itself decides.
double compared(const check::Predicate& predicate, double delta, double epsilon, Values values) {
    if (std::isinf(epsilon)) return beside(predicate, delta, epsilon);
    if (values == Values::boolean || predicate.equality())
        return truth(holds(predicate, delta, epsilon));
    return beside(predicate, delta, epsilon);
}

/// Returns rho of the atom without its negation; nothing where unknown. "Of two thresholds the low
/// end is that of the inner one, and the high end that of the outer one."
std::optional<Ends> rho_of(const check::Model& model, const Node& atom, const Samples& samples,
                           const std::vector<Telemetry>& telemetry, Values values,
                           const std::vector<double>& thresholds) {
    if (atom.kind == Node::Kind::boolean) {
        if (samples[atom.index].empty()) return {};
        const double value = truth(samples[atom.index][0] != 0);
        return Ends{value, value};
    }
    const check::Predicate& predicate = model.predicates[atom.index];
    const double delta = telemetry[atom.index].delta;
    // "with the threshold of that step"
    const bool moved = predicate.threshold.adaptation && !thresholds.empty();
    const double epsilon = moved ? thresholds[atom.index] : predicate.threshold.value;
    if (delta != delta) return {};
    const double inner =
        predicate.threshold.inner ? static_cast<double>(*predicate.threshold.inner) : epsilon;
    return Ends{compared(predicate, delta, inner, values),
                compared(predicate, delta, epsilon, values)};
}

/// Returns what the spec's `missing` makes of an unknown atom.
std::optional<Ends> rho_of_missing(const check::Model& model, const Node& atom) {
    const std::optional<bool> missing = atom.kind == Node::Kind::boolean
                                            ? model.inputs[atom.index].missing
                                            : model.predicates[atom.index].missing;
    return missing ? std::optional(Ends{truth(*missing), truth(*missing)}) : std::nullopt;
}

/// The literal's four numbers: "with known samples (v, v)"; "its literal contributes (low, low,
/// high, high) of its range".
Value literal(const std::optional<Ends>& rho, bool negated, const Unseen& range) {
    if (!rho) return {range.lowest, range.lowest, range.highest, range.highest};
    const double low = negated ? -rho->high : rho->low;
    const double high = negated ? -rho->low : rho->high;
    return {low, low, high, high};
}

Verdict verdict(const Value& value) {
    Verdict result;
    result.lower = value.lower;
    result.robustness = value.rho;
    result.robustness_high = value.rho_high;
    result.upper = value.upper;
    // "satisfied where rho >= 0, violated where rho_high < 0, else unknown"
    result.status = value.rho >= 0       ? Status::satisfied
                    : value.rho_high < 0 ? Status::violated
                                         : Status::unknown;
    return result;
}

/// "final where lower >= 0 or upper < 0"
Verdict prefix_verdict(const Value& value) {
    Verdict result = verdict(value);
    result.final = value.lower >= 0 || value.upper < 0;
    return result;
}

/// "A sliding verdict has lower = rho, upper = rho_high"; it is about a position that no later step
/// changes.
Verdict sliding_verdict(const Value& value) {
    Verdict result = verdict({value.rho, value.rho, value.rho_high, value.rho_high});
    result.final = true;
    return result;
}

class Evaluation {
public:
    Evaluation(const check::Model& model, NormalForm form, const Trace& trace, Values values,
               const Thresholds& thresholds, const Requests& requests)
        : model_(model),
          values_(values),
          thresholds_(thresholds),
          requests_(requests),
          starts_(model.monitors.size(), 0),
          form_(std::move(form)),
          samples_(accept(model, trace)) {
        for (const check::Monitor& monitor : model.monitors) {
            ahead_.push_back(horizon(model, monitor.formula));
            horizons_.push_back(monitor.sliding ? ahead_.back() : 0);
        }
    }

    Run run() {
        measure_all();
        fill_literals();
        for (std::uint64_t i = 0; i < samples_.size(); ++i) run_.verdicts.push_back(after(i));
        finish();
        return std::move(run_);
    }

    Literals literals(const std::vector<Alteration>& alterations) {
        measure_all();
        for (const Alteration& a : alterations) {
            if (a.is_predicate)
                run_.telemetry[a.step][a.index].delta = a.measured;
            else
                samples_[a.step][a.index] = {static_cast<float>(a.measured)};
        }
        fill_literals();
        return std::move(literals_);
    }

private:
    const check::Model& model_;
    Values values_;
    const Thresholds& thresholds_;
    const Requests& requests_;
    std::vector<std::uint64_t> starts_;  ///< per monitor: its position
    NormalForm form_;
    std::vector<Samples> samples_;
    std::vector<std::uint64_t> horizons_;
    std::vector<std::uint64_t> ahead_;  ///< those of prefix monitors too
    Literals literals_;
    Run run_;

    void measure_all() {
        for (std::size_t step = 0; step < samples_.size(); ++step) {
            std::vector<Telemetry> measured;
            for (const check::Predicate& predicate : model_.predicates) {
                const Measurement m = measure(model_, predicate, samples_, step);
                measured.push_back(
                    {m.delta.value_or(std::numeric_limits<double>::quiet_NaN()), m.nearest});
            }
            run_.telemetry.push_back(std::move(measured));
            std::vector<bool> present;
            for (const auto& sample : samples_[step]) present.push_back(!sample.empty());
            run_.present.push_back(std::move(present));
        }
    }

    void fill_literals() {
        literals_.values.resize(form_.nodes.size());
        literals_.ranges.resize(form_.nodes.size());
        std::vector<bool> lacking(samples_.size(), false);
        for (std::size_t n = 0; n < form_.nodes.size(); ++n) {
            const Node& node = form_.nodes[n];
            if (!node.is_atom()) continue;
            literals_.ranges[n] = range_of(model_, node, values_);
            for (std::size_t step = 0; step < samples_.size(); ++step) {
                auto rho = rho_of(model_, node, samples_[step], run_.telemetry[step], values_,
                                  thresholds_.empty() ? std::vector<double>{} : thresholds_[step]);
                if (!rho) {
                    lacking[step] = true;
                    rho = rho_of_missing(model_, node);
                }
                literals_.values[n].push_back(literal(rho, node.negated, literals_.ranges[n]));
            }
        }
        run_.missing_steps =
            static_cast<std::uint32_t>(std::count(lacking.begin(), lacking.end(), true));
    }

    /// Judges rho(f, p, i), p being 0, or the step at which the monitor was restarted, or the one
    /// after its last final verdict.
    Verdict about_its_start(Prefix& prefix, std::size_t n, std::uint64_t i) {
        std::uint64_t& p = starts_[n];
        if (i < requests_.size() && requests_[i][n]) p = i;
        Verdict result = prefix_verdict(prefix.at(form_.roots[n], p));
        run_.positions[i][n] = p;
        if (model_.monitors[n].restarts != check::Restarts::when_final) return result;
        // "that of a repeating monitor also once all that the formula looks ahead has been seen"
        if (i >= p + ahead_[n]) result.final = true;
        if (result.final) p = i + 1;
        return result;
    }

    std::vector<Verdict> after(std::uint64_t i) {
        Prefix prefix(form_, literals_, i);
        run_.positions.emplace_back(model_.monitors.size());
        std::vector<Verdict> result;
        for (std::size_t n = 0; n < model_.monitors.size(); ++n) {
            const std::uint64_t h = horizons_[n];
            if (!model_.monitors[n].sliding)
                result.push_back(about_its_start(prefix, n, i));
            else if (i >= h)
                result.push_back(sliding_verdict(
                    prefix.at(form_.roots[n], run_.positions[i][n] = i - h)));  // rho(f, i-h, i)
            else
                result.push_back({});  // "for i < h it is undecided"
        }
        return result;
    }

    /// "`finish()` reports the last h positions, cut at the end of the trace, one per call".
    /// Positions before 0 and calls after a monitor's last position are undecided; a prefix monitor
    /// repeats its last verdict.
    void finish() {
        if (samples_.empty() || horizons_.empty()) return;
        const std::uint64_t length = samples_.size();
        Prefix prefix(form_, literals_, length - 1);
        const std::uint64_t calls = *std::max_element(horizons_.begin(), horizons_.end());
        for (std::uint64_t call = 0; call < calls; ++call) {
            std::vector<Verdict> result = run_.verdicts.back();
            for (std::size_t n = 0; n < model_.monitors.size(); ++n) {
                if (!model_.monitors[n].sliding) continue;
                const std::uint64_t h = horizons_[n];
                const bool has_position = call < h && length + call >= h;
                result[n] = has_position
                                ? sliding_verdict(prefix.at(form_.roots[n], length - h + call))
                                : Verdict{};
            }
            run_.finish.push_back(std::move(result));
        }
    }
};

}  // namespace

Literals literals(const check::Model& model, const NormalForm& form, const Trace& trace,
                  Values values, const std::vector<Alteration>& alterations) {
    return Evaluation(model, form, trace, values, {}, {}).literals(alterations);
}

Run evaluate(const check::Model& model, const Trace& trace, Values values,
             const Thresholds& thresholds, const Requests& requests) {
    return Evaluation(model, normal_form(model), trace, values, thresholds, requests).run();
}

template class PrefixOf<double>;

}  // namespace etlc::reference
