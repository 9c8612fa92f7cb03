#include "check/guarantees/guarantees.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "check/numbers/decimal.hpp"

namespace etlc::check {

namespace {

using Kind = Formula::Kind;

struct Literal {
    Index formula = 0;
    bool negated = false;
};

struct Polarity {
    bool positive = false;
    bool negative = false;
};

/// p <-> q, edges of p and their number contain both p and !p.
bool has_both_polarities(Kind kind) {
    return kind == Kind::equivalence || kind == Kind::rise || kind == Kind::fall ||
           kind == Kind::count;
}

/// Returns the operands with their polarity in the negation normal form; an operand with both
/// occurs twice.
std::vector<Literal> operands_of(const Model& model, Literal literal) {
    const Formula& formula = model.formulas[literal.formula];
    std::vector<Literal> result;
    for (std::size_t i = 0; i < formula.operands.size(); ++i) {
        const bool flips =
            formula.kind == Kind::negation || (formula.kind == Kind::implication && i == 0);
        result.push_back({formula.operands[i], literal.negated != flips});
        if (has_both_polarities(formula.kind))
            result.push_back({formula.operands[i], literal.negated == flips});
    }
    return result;
}

std::map<Index, Polarity> predicates_in(const Model& model, Literal root) {
    std::vector<Polarity> visited(model.formulas.size());
    std::map<Index, Polarity> found;
    std::vector<Literal> pending{root};
    while (!pending.empty()) {
        const Literal at = pending.back();
        pending.pop_back();
        bool& seen = at.negated ? visited[at.formula].negative : visited[at.formula].positive;
        if (seen) continue;
        seen = true;
        const Formula& formula = model.formulas[at.formula];
        if (formula.kind == Kind::predicate) {
            Polarity& polarity = found[formula.index];
            (at.negated ? polarity.negative : polarity.positive) = true;
        }
        const std::vector<Literal> operands = operands_of(model, at);
        pending.insert(pending.end(), operands.begin(), operands.end());
    }
    return found;
}

/// Splits a formula into its conjuncts, each once.
std::vector<Literal> conjuncts_of(const Model& model, Literal root) {
    std::vector<Polarity> visited(model.formulas.size());
    std::vector<Literal> conjuncts;
    const auto collect = [&](const auto& self, Literal at) -> void {
        bool& seen = at.negated ? visited[at.formula].negative : visited[at.formula].positive;
        if (seen) return;
        seen = true;
        const Kind kind = model.formulas[at.formula].kind;
        const bool splits =
            kind == Kind::negation || (kind == Kind::conjunction && !at.negated) ||
            ((kind == Kind::disjunction || kind == Kind::implication) && at.negated);
        if (!splits || let_with_truth(model, at.formula) != nullptr) return conjuncts.push_back(at);
        for (const Literal operand : operands_of(model, at)) self(self, operand);
    };
    collect(collect, root);
    return conjuncts;
}

/// Adds decimals in (0, 1) exactly: digits after the point, from the right.
std::string sum(const std::vector<std::string>& alphas) {
    std::vector<std::string> digits;
    std::size_t length = 0;
    for (const std::string& alpha : alphas) {
        const Decimal decimal = Decimal::parse(alpha);
        digits.push_back(std::string(static_cast<std::size_t>(-decimal.exponent), '0') +
                         decimal.digits);
        length = std::max(length, digits.back().size());
    }
    std::string fraction(length, '0');
    std::uint64_t carry = 0;
    for (std::size_t i = length; i-- > 0;) {
        for (const std::string& one : digits)
            carry += i < one.size() ? static_cast<std::uint64_t>(one[i] - '0') : 0;
        fraction[i] = static_cast<char>('0' + carry % 10);
        carry /= 10;
    }
    return Decimal::parse(fmt::format("{}.{}", carry, fraction)).text();
}

std::string_view uncovered(const Model& model, Index predicate) {
    switch (model.predicates[predicate].threshold.origin) {
        case ThresholdOrigin::f1: return "is calibrated for F1";
        case ThresholdOrigin::class_conditional: return "is calibrated for frames, not episodes";
        case ThresholdOrigin::adaptive:
            return "has an adaptive threshold, which bounds the rate of missed frames, not of "
                   "episodes";
        case ThresholdOrigin::conformal: return "";
        case ThresholdOrigin::literal: break;
    }
    return is_own_truth(model, predicate) ? "" : "has a threshold that was not calibrated";
}

/// Whether the literal is false at its threshold, where robustness is 0 and thus satisfied: true
/// for `<` and `>`, and for negated `<=` and `>=`.
bool fails_at_zero(const Predicate& predicate, const Polarity& polarity) {
    return predicate.strict() ? polarity.positive : polarity.negative;
}

/// Returns a let with a truth of its own in the formula; otherwise null.
const Let* judged_let(const Model& model, Index formula) {
    const std::vector<Index> parts = parts_of(model, formula);
    for (const Let& let : model.lets)
        if (let.truth != kNone && std::binary_search(parts.rbegin(), parts.rend(), let.formula))
            return &let;
    return nullptr;
}

void count_groups(const Threshold& threshold, Claim& claim) {
    if (!threshold.by_group) return;
    claim.groups = claim.groups == 0 ? threshold.n : std::min(claim.groups, threshold.n);
}

Claim claim(const Model& model, Literal part, Values values) {
    Claim result;
    result.formula = part.formula;
    result.negated = part.negated;
    if (const Let* let = judged_let(model, part.formula)) {
        result.why = fmt::format(
            "'{}' has a truth of its own, to which no threshold was calibrated", let->name);
        return result;
    }
    bool no_at_zero = false;
    Polarity all;
    std::vector<std::string> alphas;
    std::string positive;
    std::string negative;
    for (const auto& [predicate, polarity] : predicates_in(model, part)) {
        const std::string_view why = uncovered(model, predicate);
        if (!why.empty() && result.why.empty())
            result.why = fmt::format("'{}' {}", model.predicates[predicate].shown(), why);
        if (model.predicates[predicate].threshold.origin != ThresholdOrigin::conformal) {
            no_at_zero |= fails_at_zero(model.predicates[predicate], polarity);
            continue;
        }
        // Without a sample it may miss its truth, and with it an alarm.
        if (polarity.negative && model.predicates[predicate].missing == false)
            result.why = fmt::format("'{}' is false when its sample is missing",
                                     model.predicates[predicate].shown());
        alphas.push_back(model.predicates[predicate].threshold.alpha);
        count_groups(model.predicates[predicate].threshold, result);
        if (polarity.positive) positive = model.predicates[predicate].shown();
        if (polarity.negative) negative = model.predicates[predicate].shown();
        all.positive |= polarity.positive;
        all.negative |= polarity.negative;
    }
    if (!result.why.empty()) return result;
    result.bound = sum(alphas);
    if (all.positive && all.negative) {
        result.why = positive == negative
                         ? fmt::format("'{}' occurs both plain and negated", positive)
                         : fmt::format("'{}' occurs plain and '{}' negated", positive, negative);
    } else if (alphas.empty()) {
        result.kind = Claim::Kind::exact;
    } else if (Decimal::parse(result.bound) >= Decimal::parse("1")) {
        result.why = fmt::format("the alphas of its predicates add up to {}", result.bound);
    } else {
        result.kind = all.positive ? Claim::Kind::missed_success : Claim::Kind::missed_alarm;
    }
    const bool of_violations =
        result.kind == Claim::Kind::exact || result.kind == Claim::Kind::missed_alarm;
    result.zero_aside = of_violations && no_at_zero && values != Values::boolean;
    return result;
}

bool reads_embedding(const Model& model, const Predicate& predicate) {
    return std::any_of(predicate.inputs.begin(), predicate.inputs.end(),
                       [&](Index input) { return model.inputs[input].is_embedding(); });
}

/// Returns P(Binomial(n, x) >= k) = P(Beta(k, n + 1 - k) <= x).
double binomial_tail(std::uint64_t n, std::uint64_t k, double x) {
    const auto count = static_cast<double>(n);
    double tail = 0;
    for (std::uint64_t i = k; i <= n; ++i) {
        const auto successes = static_cast<double>(i);
        tail += std::exp(std::lgamma(count + 1) - std::lgamma(successes + 1) -
                         std::lgamma(count - successes + 1) + successes * std::log(x) +
                         (count - successes) * std::log1p(-x));
    }
    return tail;
}

}  // namespace

bool is_own_truth(const Model& model, Index predicate) {
    const bool labelled =
        std::any_of(model.truths.begin(), model.truths.end(),
                    [&](const Truth& truth) { return truth.predicate == predicate; });
    const Predicate& p = model.predicates[predicate];
    return p.threshold.origin == ThresholdOrigin::literal && !labelled &&
           !reads_embedding(model, p);
}

std::vector<Claim> claims(const Model& model, const Monitor& monitor, Values values) {
    if (monitor.calibration) {
        const bool alarms = monitor.calibration->against == Against::missed_alarm;
        Claim whole;
        whole.kind = alarms ? Claim::Kind::missed_alarm : Claim::Kind::missed_success;
        whole.formula = monitor.formula;
        whole.bound = Decimal::parse(monitor.calibration->threshold.alpha).text();
        count_groups(monitor.calibration->threshold, whole);
        return {whole};
    }
    std::vector<Claim> result{claim(model, {monitor.formula, false}, values)};
    if (result.front().kind != Claim::Kind::nothing) return result;
    const std::vector<Literal> conjuncts = conjuncts_of(model, {monitor.formula, false});
    if (conjuncts.size() < 2) return result;
    for (const Literal conjunct : conjuncts) {
        Claim part = claim(model, conjunct, values);
        part.part = shown(model, conjunct.formula);
        if (conjunct.negated) part.part = fmt::format("!({})", part.part);
        result.push_back(std::move(part));
    }
    return result;
}

std::string text(const Claim& claim) {
    const std::string_view aside = claim.zero_aside ? ", except at robustness 0" : "";
    switch (claim.kind) {
        case Claim::Kind::exact:
            return fmt::format("exact{}: no predicate is calibrated, and each is its own truth",
                               aside);
        case Claim::Kind::missed_success:
        case Claim::Kind::missed_alarm:
            return fmt::format(
                "P(some verdict of {} misses {}) <= {}{}{}",
                claim.groups > 0 ? "an episode of a new group" : "a new episode",
                claim.kind == Claim::Kind::missed_success ? "a success" : "an alarm", claim.bound,
                claim.groups > 0 ? ", from " + diag::counted(claim.groups, "group") : "", aside);
        case Claim::Kind::nothing: break;
    }
    return "no guarantee: " + claim.why;
}

std::string place(const Threshold& threshold) {
    return fmt::format("{} of {}{}", threshold.k, threshold.n,
                       !threshold.by_group ? ""
                       : threshold.n == 1  ? " group"
                                           : " groups");
}

std::string origin(const Threshold& threshold) {
    switch (threshold.origin) {
        case ThresholdOrigin::literal: return "written in the spec; no guarantee";
        case ThresholdOrigin::f1: return "calibrated for F1; no guarantee";
        case ThresholdOrigin::conformal:
            return fmt::format("conformal, alpha = {}; score {}, coverage {:.3f} to {:.3f}",
                               threshold.alpha, place(threshold),
                               coverage_quantile(threshold.n, threshold.k, 0.05),
                               coverage_quantile(threshold.n, threshold.k, 0.95));
        case ThresholdOrigin::class_conditional:
            return fmt::format(
                "class-conditional, alpha = {}; score {} of {} frames; no guarantee for episodes",
                threshold.alpha, threshold.k, threshold.n);
        case ThresholdOrigin::adaptive:
            return fmt::format(
                "adaptive, alpha = {}, gamma = {}, in [{}, {}]; starts at conformal score {}",
                threshold.alpha, threshold.adaptation->gamma, threshold.adaptation->lo,
                threshold.adaptation->hi, place(threshold));
    }
    return "";
}

std::string miss_bound(const Predicate& predicate) {
    const Adaptation& adaptation = *predicate.threshold.adaptation;
    const double start = predicate.threshold.value;
    const double room = predicate.upper_bound() ? static_cast<double>(adaptation.range.high) - start
                                                : start - static_cast<double>(adaptation.range.low);
    const double alpha = to_double(predicate.threshold.alpha);
    return fmt::format("{} T + {:.1f} + {:.4g} H", predicate.threshold.alpha,
                       std::ceil(10 * room / to_double(adaptation.gamma)) / 10, 1 - alpha);
}

double coverage_quantile(std::uint64_t n, std::uint64_t k, double q) {
    double low = 0;
    double high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (binomial_tail(n, k, middle) < q ? low : high) = middle;
    }
    return (low + high) / 2;
}

}  // namespace etlc::check
