#include "check/guarantees/guarantees.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "check/guarantees/calibrated.hpp"
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
bool has_both_polarities(const Formula& formula) {
    const Kind kind = formula.kind;
    return kind == Kind::equivalence || kind == Kind::rise || kind == Kind::fall ||
           (kind == Kind::count && !formula.each_step);
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
        if (has_both_polarities(formula))
            result.push_back({formula.operands[i], literal.negated == flips});
    }
    return result;
}

/// Visits each part of a formula once for each polarity.
template <class Visit>
void each_literal(const Model& model, Literal root, const Visit& visit) {
    std::vector<Polarity> visited(model.formulas.size());
    std::vector<Literal> pending{root};
    while (!pending.empty()) {
        const Literal at = pending.back();
        pending.pop_back();
        bool& seen = at.negated ? visited[at.formula].negative : visited[at.formula].positive;
        if (seen) continue;
        seen = true;
        visit(at);
        const std::vector<Literal> operands = operands_of(model, at);
        pending.insert(pending.end(), operands.begin(), operands.end());
    }
}

std::map<Index, Polarity> predicates_in(const Model& model, Literal root) {
    std::map<Index, Polarity> found;
    each_literal(model, root, [&](Literal at) {
        const Formula& formula = model.formulas[at.formula];
        if (formula.kind != Kind::predicate) return;
        Polarity& polarity = found[formula.index];
        (at.negated ? polarity.negative : polarity.positive) = true;
    });
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
        case ThresholdOrigin::risk: return "is calibrated for a share of the frames, not for each";
        case ThresholdOrigin::conformal:
        case ThresholdOrigin::normal: return "";
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

void count_groups(const Threshold& threshold, Guarantee& guarantee) {
    if (!threshold.by_group) return;
    for (const std::uint64_t n : {threshold.n, threshold.inner_n})
        if (n > 0) guarantee.groups = guarantee.groups == 0 ? n : std::min(guarantee.groups, n);
}

bool bounds_misses(const Threshold& threshold) {
    return threshold.against != Against::false_positives;
}
bool bounds_false_positives(const Threshold& threshold) {
    return threshold.against != Against::misses;
}

/// One of the two errors of a verdict: the bounds that it rests on, and what voids it.
struct Line {
    std::vector<std::string> rates;
    Index without = kNone;  ///< a predicate that lacks a bound
    Index missing = kNone;  ///< one whose `missing` voids its bound

    bool holds() const { return without == kNone && missing == kNone; }
};

/// The bounds of the predicates in a formula.
struct Bounds {
    Line satisfied;  ///< satisfied wrongly
    Line violated;   ///< violated wrongly
    std::vector<std::string> all;
    bool of_both = false;       ///< some predicate is calibrated against both errors
    bool with_missing = false;  ///< bounds on violations include the steps with missing samples

    /// Adds what a literal contributes. A negated one is true where the predicate is called false.
    void add(const Model& model, Index index, bool negated) {
        const Predicate& predicate = model.predicates[index];
        const Threshold& threshold = predicate.threshold;
        const auto take = [&](Line& line, bool bounded, const std::string& rate, bool missing) {
            if (!bounded) {
                line.without = index;
                return;
            }
            line.rates.push_back(rate);
            // A bound on successes alone excludes the steps with missing samples.
            if (predicate.missing == missing && (with_missing || &line == &satisfied))
                line.missing = index;
        };
        take(negated ? satisfied : violated, bounds_misses(threshold), threshold.alpha, false);
        take(negated ? violated : satisfied, bounds_false_positives(threshold),
             threshold.rate_of_false_positives(), true);
    }
};

Bounds bounds_of(const Model& model, const std::map<Index, Polarity>& predicates) {
    Bounds result;
    const auto is_calibrated = [&](Index predicate) {
        return model.predicates[predicate].threshold.bounds_episodes();
    };
    for (const auto& [predicate, polarity] : predicates) {
        const Threshold& threshold = model.predicates[predicate].threshold;
        result.of_both |= is_calibrated(predicate) && threshold.against == Against::both;
        result.with_missing |= threshold.origin == ThresholdOrigin::normal;
    }
    result.with_missing |= result.of_both;
    for (const auto& [predicate, polarity] : predicates) {
        if (!is_calibrated(predicate)) continue;
        if (polarity.positive) result.add(model, predicate, false);
        if (polarity.negative) result.add(model, predicate, true);
        const Threshold& threshold = model.predicates[predicate].threshold;
        if (bounds_misses(threshold)) result.all.push_back(threshold.alpha);
        if (bounds_false_positives(threshold))
            result.all.push_back(threshold.rate_of_false_positives());
    }
    return result;
}

/// Returns why neither error is bounded.
std::string why_nothing(const Model& model, const Bounds& bounds) {
    const auto name = [&](Index predicate) { return model.predicates[predicate].shown(); };
    for (const Line* const line : {&bounds.satisfied, &bounds.violated})
        if (line->missing != kNone)
            return fmt::format("'{}' is {} when its sample is missing", name(line->missing),
                               *model.predicates[line->missing].missing);
    const Index plain = bounds.satisfied.without;
    const Index negated = bounds.violated.without;
    if (plain == negated) return fmt::format("'{}' occurs both plain and negated", name(plain));
    const auto misses_only = [&](Index predicate) {
        return bounds_misses(model.predicates[predicate].threshold);
    };
    if (misses_only(plain) && misses_only(negated))
        return fmt::format("'{}' occurs plain and '{}' negated", name(plain), name(negated));
    return fmt::format("'{}' may make it satisfied wrongly and '{}' violated wrongly", name(plain),
                       name(negated));
}

/// Returns the guarantees about a formula or conjunct, at least one.
std::vector<Guarantee> guarantees_about(const Model& model, Literal part, Values values) {
    Guarantee base;
    base.formula = part.formula;
    base.negated = part.negated;
    if (const Let* let = judged_let(model, part.formula)) {
        base.why = fmt::format("'{}' has a truth of its own, to which no threshold was calibrated",
                               let->name);
        return {base};
    }
    const std::map<Index, Polarity> predicates = predicates_in(model, part);
    bool no_at_zero = false;
    bool of_labels = false;  // some threshold was calibrated with labels
    for (const auto& [predicate, polarity] : predicates) {
        const Predicate& of = model.predicates[predicate];
        const std::string_view why = uncovered(model, predicate);
        if (!why.empty() && base.why.empty()) base.why = fmt::format("'{}' {}", of.shown(), why);
        of_labels |= of.threshold.origin == ThresholdOrigin::conformal;
        base.normal |= of.threshold.origin == ThresholdOrigin::normal;
        if (of.threshold.bounds_episodes())
            count_groups(of.threshold, base);
        else
            no_at_zero |= fails_at_zero(of, polarity);
    }
    if (!base.why.empty()) return {base};
    std::vector<Guarantee> result;
    const auto add = [&](Guarantee::Kind kind, const std::vector<std::string>& rates) {
        Guarantee guarantee = base;
        guarantee.kind = kind;
        guarantee.bound = sum(rates);
        const bool of_violations = kind != Guarantee::Kind::missed_success &&
                                   kind != Guarantee::Kind::false_alarm &&
                                   kind != Guarantee::Kind::violated_wrongly;
        guarantee.zero_aside = of_violations && no_at_zero && values != Values::boolean;
        if (Decimal::parse(guarantee.bound) >= Decimal::parse("1"))
            base.why = fmt::format("the alphas of its predicates add up to {}", guarantee.bound);
        else
            result.push_back(std::move(guarantee));
    };
    const Bounds bounds = bounds_of(model, predicates);
    const auto& [satisfied, violated, all, of_both, with_missing] = bounds;
    if (all.empty()) {
        add(Guarantee::Kind::exact, {});
    } else if (base.normal && !of_labels && violated.holds() && !satisfied.holds()) {
        add(Guarantee::Kind::false_alarm, all);
    } else if (!base.normal && !of_both && satisfied.holds() != violated.holds()) {
        add(violated.holds() ? Guarantee::Kind::missed_success : Guarantee::Kind::missed_alarm,
            all);
    } else if (satisfied.holds() || violated.holds()) {
        if (satisfied.holds()) add(Guarantee::Kind::satisfied_wrongly, satisfied.rates);
        if (violated.holds()) add(Guarantee::Kind::violated_wrongly, violated.rates);
        if (satisfied.holds() && violated.holds()) add(Guarantee::Kind::wrong, all);
    } else {
        base.why = why_nothing(model, bounds);
    }
    if (result.empty()) result.push_back(base);
    return result;
}

/// Returns the guarantees of a monitor that is calibrated as a whole.
std::vector<Guarantee> guarantees_as_a_whole(const Monitor& monitor) {
    const Threshold& threshold = *monitor.calibration;
    const bool by_share = threshold.origin == ThresholdOrigin::risk;
    std::vector<Guarantee> result;
    const auto add = [&](Guarantee::Kind kind, const std::vector<std::string>& rates) {
        Guarantee& guarantee = result.emplace_back();
        guarantee.kind = kind;
        guarantee.formula = monitor.formula;
        guarantee.bound = sum(rates);
        count_groups(threshold, guarantee);
    };
    if (threshold.origin == ThresholdOrigin::normal) {
        add(Guarantee::Kind::false_alarm, {threshold.alpha});
        result.back().normal = true;
        return result;
    }
    const std::string& of_alarms = threshold.rate_of_false_positives();
    if (threshold.against == Against::both && !by_share) {
        add(Guarantee::Kind::satisfied_wrongly, {of_alarms});
        add(Guarantee::Kind::violated_wrongly, {threshold.alpha});
        add(Guarantee::Kind::wrong, {of_alarms, threshold.alpha});
        // One error is bounded by its rate in any case; both together may be certain.
        if (Decimal::parse(result.back().bound) >= Decimal::parse("1")) result.pop_back();
        return result;
    }
    if (threshold.against != Against::missed_success)
        add(by_share ? Guarantee::Kind::satisfied_share : Guarantee::Kind::missed_alarm,
            {of_alarms});
    if (threshold.against != Against::missed_alarm)
        add(by_share ? Guarantee::Kind::violated_share : Guarantee::Kind::missed_success,
            {threshold.alpha});
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

void for_each_literal(const Model& model, Index formula,
                      const std::function<void(Index part, bool negated)>& visit) {
    each_literal(model, {formula, false}, [&](Literal at) { visit(at.formula, at.negated); });
}

namespace {

/// Returns what the predicates guarantee, for the whole formula or for each conjunct.
std::vector<Guarantee> guarantees_of_predicates(const Model& model, const Monitor& monitor,
                                                Values values) {
    std::vector<Guarantee> result = guarantees_about(model, {monitor.formula, false}, values);
    if (result.front().kind != Guarantee::Kind::nothing) return result;
    const std::vector<Literal> conjuncts = conjuncts_of(model, {monitor.formula, false});
    if (conjuncts.size() < 2) return result;
    for (const Literal conjunct : conjuncts)
        for (Guarantee& part : guarantees_about(model, conjunct, values)) {
            part.part = shown(model, conjunct.formula);
            if (conjunct.negated) part.part = fmt::format("!({})", part.part);
            result.push_back(std::move(part));
        }
    return result;
}

}  // namespace

std::vector<Guarantee> guarantees(const Model& model, const Monitor& monitor, Values values) {
    if (monitor.calibration) return guarantees_as_a_whole(monitor);
    std::vector<Guarantee> result = guarantees_of_predicates(model, monitor, values);
    if (!monitor.duration) return result;
    std::erase_if(result, [](const Guarantee& one) {
        return one.kind == Guarantee::Kind::nothing || one.kind == Guarantee::Kind::exact;
    });
    const Threshold& threshold = monitor.duration->threshold;
    Guarantee alarms;
    alarms.kind = Guarantee::Kind::false_alarm;
    alarms.formula = monitor.formula;
    alarms.bound = Decimal::parse(threshold.alpha).text();
    count_groups(threshold, alarms);
    result.insert(result.begin(), std::move(alarms));
    return result;
}

namespace {

/// Returns what some verdict does with at most that probability.
std::string_view what(Guarantee::Kind kind) {
    switch (kind) {
        case Guarantee::Kind::missed_success: return "misses a success";
        case Guarantee::Kind::missed_alarm: return "misses an alarm";
        case Guarantee::Kind::false_alarm: return "is violated for good";
        case Guarantee::Kind::satisfied_wrongly: return "is satisfied wrongly";
        case Guarantee::Kind::violated_wrongly: return "is violated wrongly";
        default: return "is wrong";
    }
}

/// Returns a rate in percent, exactly: "10" for 0.1.
std::string percent(const std::string& rate) {
    Decimal decimal = Decimal::parse(rate);
    decimal.exponent += 2;
    return decimal.text();
}

}  // namespace

std::string text(const Guarantee& guarantee) {
    const std::string part = guarantee.part.empty() ? "" : fmt::format("part {}: ", guarantee.part);
    const std::string_view aside = guarantee.zero_aside ? ", except at robustness 0" : "";
    const std::string groups =
        guarantee.groups > 0 ? ", from " + diag::counted(guarantee.groups, "group") : "";
    const auto share = [&](const char* predicted, const char* actual) {
        return fmt::format(
            "{}on average over calibrations and {}, {} at no more than {} % of the steps at which "
            "it "
            "is truly {}{}",
            part, guarantee.groups > 0 ? "episodes of new groups" : "new episodes", predicted,
            percent(guarantee.bound), actual, groups);
    };
    switch (guarantee.kind) {
        case Guarantee::Kind::nothing: return part + "no guarantee: " + guarantee.why;
        case Guarantee::Kind::exact:
            return fmt::format("{}exact{}: no predicate is calibrated, and each is its own truth",
                               part, aside);
        case Guarantee::Kind::satisfied_share: return share("satisfied", "violated");
        case Guarantee::Kind::violated_share: return share("violated", "satisfied");
        default: break;
    }
    const std::string episode =
        fmt::format("a{} {}", guarantee.groups > 0 ? (guarantee.normal ? "" : "n") : " new",
                    fmt::format("{}episode{}", guarantee.normal ? "normal " : "",
                                guarantee.groups > 0 ? " of a new group" : ""));
    const std::string event =
        guarantee.normal && guarantee.kind == Guarantee::Kind::false_alarm
            ? "a false alarm in " + episode
            : fmt::format("some verdict of {} {}", episode, what(guarantee.kind));
    return fmt::format("{}P({}) <= {}{}{}", part, event, guarantee.bound, groups, aside);
}

std::string exchangeability(bool by_group) {
    return fmt::format("Probabilities are over the {} together, which must be exchangeable{}.",
                       by_group ? "groups of demonstrations and the new group"
                                : "demonstrations and the new episode",
                       by_group ? "; a group counts once, with the worst of its demonstrations"
                                : ", per episode as recorded");
}

std::string place(const Threshold& threshold, bool inner) {
    const std::uint64_t n = inner ? threshold.inner_n : threshold.n;
    const std::uint64_t k = inner ? threshold.inner_k : threshold.k;
    return fmt::format("{} of {}{}", k > n ? "none" : fmt::format("{}", k), n,
                       !threshold.by_group ? ""
                       : n == 1            ? " group"
                                           : " groups");
}

std::string numbers(const Threshold& threshold) {
    const Range range = threshold.range();
    return threshold.inner ? fmt::format("{} to {}", range.low, range.high)
                           : fmt::format("{}", threshold.value);
}

namespace {

/// Returns "score 17 of 18, coverage 0.838 to 0.997"; nothing by risk.
std::string score(const Threshold& threshold, bool inner) {
    const std::uint64_t n = inner ? threshold.inner_n : threshold.n;
    const std::uint64_t k = inner ? threshold.inner_k : threshold.k;
    if (threshold.origin == ThresholdOrigin::risk) return "";
    if (k > n) return fmt::format("{}, too few", diag::counted(n, "score"));
    return fmt::format("score {}, coverage {:.3f} to {:.3f}", place(threshold, inner),
                       coverage_quantile(n, k, 0.05), coverage_quantile(n, k, 0.95));
}

/// Describes the one or two thresholds: of a predicate where it is true and false, of a monitor
/// where it is satisfied and violated. `is_upper`: true is below.
std::string parts(const Threshold& threshold, const char* yes, const char* no, bool is_upper) {
    const auto scored = [&](bool inner) {
        const std::string text = score(threshold, inner);
        return text.empty() ? text : fmt::format(" ({})", text);
    };
    const auto one = [&](const char* word, float at, const char* below, const char* above,
                         bool inner) {
        return std::isinf(at)
                   ? fmt::format("never {}{}", word, scored(inner))
                   : fmt::format("{} {} {}{}", word, is_upper ? below : above, at, scored(inner));
    };
    if (threshold.against != Against::both) return score(threshold, false);
    if (!threshold.inner)
        return fmt::format("halfway between {}{} and {}{}, never unknown", yes, scored(true), no,
                           scored(false));
    return fmt::format("{}, {}, unknown between", one(yes, *threshold.inner, "up to", "from", true),
                       one(no, threshold.value, "beyond", "below", false));
}

/// Describes a threshold by conformal or risk.
std::string origin_of_episodes(const Threshold& threshold) {
    std::string text =
        fmt::format("{}, alpha = {}", method_name(threshold.origin), threshold.alpha);
    if (!threshold.beta.empty()) text += ", beta = " + threshold.beta;
    if (threshold.against != Against::misses && threshold.origin != ThresholdOrigin::normal)
        text += fmt::format(", against {}", word(threshold.against));
    if (threshold.within > 0)
        text += fmt::format(", within {} of a change", diag::counted(threshold.within, "step"));
    const bool is_upper = threshold.inner && *threshold.inner < threshold.value;
    const std::string described = parts(threshold, "true", "false", is_upper);
    if (!described.empty()) text += "; " + described;
    if (threshold.origin != ThresholdOrigin::risk) return text;
    text += "; on average over calibrations and episodes";
    const auto add = [&](bool bounded, const std::string& rate, const char* frames) {
        if (bounded)
            text +=
                fmt::format(", at most {} % of the frames at which it {}", percent(rate), frames);
    };
    add(bounds_misses(threshold), threshold.alpha, "holds are called false");
    add(bounds_false_positives(threshold), threshold.rate_of_false_positives(),
        "does not hold are called true");
    return text + "; no guarantee for verdicts";
}

}  // namespace

std::string origin(const Threshold& threshold) {
    switch (threshold.origin) {
        case ThresholdOrigin::literal: return "written in the spec; no guarantee";
        case ThresholdOrigin::f1: return "calibrated for F1; no guarantee";
        case ThresholdOrigin::conformal:
        case ThresholdOrigin::normal:
        case ThresholdOrigin::risk: return origin_of_episodes(threshold);
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

std::string of_shift(const Threshold& shift) {
    const std::string text = parts(shift, "satisfied", "violated", false);
    if (shift.inner) return "rho: " + text;
    return fmt::format("rho minus {}{}{}", shift.value, text.empty() ? "" : ", ", text);
}

namespace {

/// Returns "54 steps (1.8 s)"; without seconds if the spec has no rate.
std::string steps_text(const Model& model, std::uint32_t steps) {
    const std::string text = diag::counted(steps, "step");
    if (!(model.step_seconds > 0)) return text;
    return fmt::format("{} ({:.4g} s)", text, steps * model.step_seconds);
}

}  // namespace

std::string of_duration(const Model& model, const Duration& duration) {
    const Threshold& threshold = duration.threshold;
    return fmt::format("within {}, from {}; {}", steps_text(model, duration.steps),
                       threshold.by_group ? diag::counted(threshold.n, "group")
                                          : diag::counted(threshold.n, "demonstration"),
                       score(threshold, false));
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
