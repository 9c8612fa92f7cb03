#include "reference/explanation.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace etlc::reference {
namespace {

/// "satisfied where rho >= 0, violated where rho_high < 0, else unknown"; "final where lower >= 0
/// [...] or upper < 0".
Outcome outcome_from(const Value& value) {
    const Status status = value.rho >= 0       ? Status::satisfied
                          : value.rho_high < 0 ? Status::violated
                                               : Status::unknown;
    return {status, value.lower >= 0 || value.upper < 0};
}

/// "Of two equal values that of the earlier sample counts as farther from zero, and a zero as
/// positive; a negation turns the order around": less is less.
using Ordered = std::pair<double, std::pair<int, Sample>>;

struct Less {
    bool operator()(const Ordered& a, const Ordered& b) const {
        if (a.first != b.first) return a.first < b.first;
        const auto& [sign_a, sample_a] = a.second;
        const auto& [sign_b, sample_b] = b.second;
        if (sign_a != sign_b) return sign_a < sign_b;
        return sign_a > 0 ? sample_b < sample_a : sample_a < sample_b;
    }
};

/// Returns what a monitor calibrated as a whole subtracts from the low ends of its values, and from
/// the high ones.
std::pair<double, double> shifts_of(const check::Monitor& monitor) {
    if (!monitor.calibration) return {0, 0};
    return {monitor.calibration->low(), monitor.calibration->value};
}

}  // namespace

Explained::Explained(const check::Model& model, NormalForm form, const Trace& trace,
                     check::Values values, Index monitor, std::uint64_t position,
                     std::uint64_t step)
    : model_(model),
      trace_(trace),
      values_(values),
      form_(std::move(form)),
      literals_(literals(model, form_, trace, values)),
      root_(form_.roots[monitor]),
      position_(position),
      step_(step),
      shifts_(shifts_of(model.monitors[monitor])),
      outcome_(outcome_of(value(literals_))) {}

Outcome Explained::outcome_of(const Value& value) const {
    const auto [low, high] = shifts_;
    return outcome_from(
        {value.lower - low, value.rho - low, value.rho_high - high, value.upper - high});
}

Value Explained::value(const Literals& literals) const {
    return Prefix(form_, literals, step_).at(root_, position_);
}

double Explained::deciding(const Value& value) const {
    if (outcome_.status == Status::satisfied) return outcome_.for_good ? value.lower : value.rho;
    return outcome_.for_good ? value.upper : value.rho_high;
}

Sample Explained::sample(const Node& literal, std::uint64_t step) const {
    const bool is_predicate = literal.kind == Node::Kind::predicate;
    const check::Span span =
        is_predicate ? model_.predicates[literal.index].span : model_.inputs[literal.index].span;
    return {step, span.begin, is_predicate, literal.index};
}

Outcome Explained::outcome_with_only(const SampleSet& known) const {
    Literals literals = literals_;
    for (std::size_t n = 0; n < form_.nodes.size(); ++n) {
        if (!form_.nodes[n].is_atom()) continue;
        const Unseen& range = literals.ranges[n];
        for (std::uint64_t step = 0; step <= step_; ++step)
            if (!known.contains(sample(form_.nodes[n], step)))
                literals.values[n][step] = {range.lowest, range.lowest, range.highest,
                                            range.highest};
    }
    return outcome_of(value(literals));
}

Outcome Explained::outcome_with(const std::vector<Alteration>& alterations) const {
    return outcome_of(value(literals(model_, form_, trace_, values_, alterations)));
}

/// Numbers all values of literals in their order, and the ranges of what comes after the prefix:
/// the deciding value then is the number of its sample.
std::optional<Sample> Explained::critical() const {
    const bool low = outcome_.status == Status::satisfied;
    const auto ordered = [&](std::size_t n, std::uint64_t step) {
        const Value& v = literals_.values[n][step <= step_ ? step : 0];
        const Unseen& range = literals_.ranges[n];
        const double value = step > step_ ? (low ? range.lowest : range.highest)
                             : low        ? v.rho
                                          : v.rho_high;
        const bool negated = form_.nodes[n].negated;
        const int sign = (negated ? -value : value) < 0 ? -1 : 1;
        return Ordered{value, {negated ? -sign : sign, sample(form_.nodes[n], step)}};
    };
    std::map<Ordered, double, Less> numbers;
    const auto for_each = [&](const auto& visit) {
        for (std::size_t n = 0; n < form_.nodes.size(); ++n)
            for (std::uint64_t step = 0; step <= step_ + 1 && form_.nodes[n].is_atom(); ++step)
                visit(n, step);
    };
    for_each([&](std::size_t n, std::uint64_t step) { numbers.emplace(ordered(n, step), 0); });
    double next = 0;
    for (auto& [value, number] : numbers) number = next++;
    Literals literals = literals_;
    for_each([&](std::size_t n, std::uint64_t step) {
        const double number = numbers.at(ordered(n, step));
        if (step > step_)
            literals.ranges[n] = {number, number};
        else
            literals.values[n][step] = {number, number, number, number};
    });
    const double found = deciding(value(literals));
    for (const auto& [value, number] : numbers)
        if (number == found && value.second.second.step <= step_) return value.second.second;
    return std::nullopt;
}

SampleSet Explained::explanation() const {
    const bool low = outcome_.status == Status::satisfied;
    const double least = deciding(value(literals_));
    SampleSet kept;
    for (std::size_t n = 0; n < form_.nodes.size(); ++n)
        for (std::uint64_t step = 0; step <= step_ && form_.nodes[n].is_atom(); ++step) {
            const Value& v = literals_.values[n][step];
            const Unseen& range = literals_.ranges[n];
            const bool is_known =
                v.rho == v.rho_high || v.rho != range.lowest || v.rho_high != range.highest;
            const bool supports = low ? v.rho >= least : v.rho_high <= least;
            if (is_known && supports) kept.insert(sample(form_.nodes[n], step));
        }
    std::vector<Sample> order(kept.rbegin(), kept.rend());
    const std::optional<Sample> last = critical();
    std::stable_partition(order.begin(), order.end(), [&](const Sample& s) { return s != last; });
    for (const Sample& candidate : order) {
        kept.erase(candidate);
        if (outcome_with_only(kept) != outcome_) kept.insert(candidate);
    }
    return kept;
}

}  // namespace etlc::reference
