#include "episodes/truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "check/points/points.hpp"
#include "episodes/exact_distance.hpp"
#include "episodes/recent_frames.hpp"

namespace etlc::episodes {

namespace {

using check::Expr;
using check::Formula;
using check::Input;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Label negate(Label label) {
    if (label == Label::unknown) return label;
    return label == Label::yes ? Label::no : Label::yes;
}

Label label_of(bool value) {
    return value ? Label::yes : Label::no;
}

/// "A sample with any element not finite, or a scalar outside its declared range, counts as
/// missing": the monitor sees float32, so that is what has to be finite and in range.
bool usable(const Input& input, const std::vector<double>& sample) {
    if (sample.empty()) return false;
    return std::all_of(sample.begin(), sample.end(), [&](double x) {
        const auto narrowed = static_cast<float>(x);
        return std::isfinite(narrowed) && input.range.contains(narrowed);
    });
}

/// Returns whether the sample is not stale: monitors compare what they get.
bool is_fresh(const Input& input, const std::vector<double>& sample,
              execute::Freshness& freshness) {
    if (input.stale_after == 0) return true;
    std::string why;
    const auto narrowed = execute::narrow(input, true, sample, why);
    const bool comparable =
        narrowed && std::all_of(narrowed->values.begin(), narrowed->values.end(),
                                [](float x) { return std::isfinite(x); });
    return !comparable || freshness.accepts(input, narrowed->values);
}

}  // namespace

TruthEvaluator::TruthEvaluator(const check::Model& model, const std::vector<Index>& formulas)
    : model_(model) {
    std::vector<bool> wanted(model.formulas.size());
    for (const Index formula : formulas) wanted[formula] = true;
    std::set<Index> inputs;
    std::set<Index> pasts;
    for (Index i = static_cast<Index>(wanted.size()); i-- > 0;) {
        if (!wanted[i]) continue;
        const Formula& formula = model.formulas[i];
        for (const Index operand : formula.operands) wanted[operand] = true;
        order_.push_back(i);
        if (formula.kind == Formula::Kind::boolean_input) inputs.insert(formula.index);
        if (formula.kind != Formula::Kind::predicate) continue;
        const std::vector<Index>& read = model.predicates[formula.index].inputs;
        inputs.insert(read.begin(), read.end());
        check::for_each(model.predicates[formula.index].expression, [&](const Expr& e) {
            if (e.kind == Expr::Kind::past) pasts.insert(e.index);
        });
        check::for_each_distance(model.predicates[formula.index].expression, [&](Index d) {
            for (const Index point : {model.distances[d].point, model.distances[d].other})
                if (point != check::kNone)
                    longest_delay_ = std::max(longest_delay_, check::longest_delay(model, point));
        });
    }
    std::reverse(order_.begin(), order_.end());
    inputs_.assign(inputs.begin(), inputs.end());
    read_pasts_.assign(pasts.begin(), pasts.end());
    for (const Index past : read_pasts_) past_values_.emplace_back(model.pasts[past]);
    reset();
}

void TruthEvaluator::reset() {
    frame_ = 0;
    labels_.assign(model_.formulas.size(), Label::unknown);
    memories_.assign(model_.formulas.size(), {});
    values_.assign(model_.inputs.size(), {});
    earlier_.clear();
    held_.assign(model_.inputs.size(), {});
    ages_.assign(model_.inputs.size(), 0);
    freshness_.assign(model_.inputs.size(), {});
    for (PastValues& past : past_values_) past.reset();
    pasts_.assign(model_.pasts.size(), kUnknown);
}

void TruthEvaluator::step(const Frame& frame) {
    ++frame_;
    if (longest_delay_ > 0 && frame_ > 1) {
        earlier_.push_front(values_);
        if (earlier_.size() > longest_delay_) earlier_.pop_back();
    }
    take_inputs(frame);
    take_pasts();
    for (const Index index : order_) labels_[index] = value(index);
}

void TruthEvaluator::take_inputs(const Frame& frame) {
    for (const Index i : inputs_) {
        const Input& input = model_.inputs[i];
        if (usable(input, frame[i]) && is_fresh(input, frame[i], freshness_[i])) {
            held_[i] = frame[i];
            ages_[i] = 0;
            if (input.type == check::InputType::i8)
                for (double& x : held_[i]) x *= static_cast<double>(input.scale);
            values_[i] = held_[i];
            continue;
        }
        values_[i] = ages_[i] < input.hold ? held_[i] : std::vector<double>{};
        ages_[i] += ages_[i] < input.hold ? 1 : 0;
    }
}

/// A past number comes after those that it contains.
void TruthEvaluator::take_pasts() {
    for (std::size_t i = 0; i < read_pasts_.size(); ++i) {
        const Index past = read_pasts_[i];
        pasts_[past] = past_values_[i].push(expression(model_.pasts[past].expression));
    }
}

Label TruthEvaluator::value(Index index) {
    using enum Formula::Kind;
    const Formula& formula = model_.formulas[index];
    const auto at = [&](std::size_t i) { return labels_[formula.operands[i]]; };
    const auto fold = [&](auto combine) {
        Label result = at(0);
        for (std::size_t i = 1; i < formula.operands.size(); ++i) result = combine(result, at(i));
        return result;
    };
    const auto both = [](Label a, Label b) { return std::min(a, b); };
    const auto either = [](Label a, Label b) { return std::max(a, b); };
    switch (formula.kind) {
        case constant_true: return Label::yes;
        case constant_false: return Label::no;
        case predicate: return compare(model_.predicates[formula.index]);
        case boolean_input: {
            const std::vector<double>& sample = values_[formula.index];
            return sample.empty() ? Label::unknown : label_of(sample[0] != 0);
        }
        case negation: return negate(at(0));
        case conjunction: return fold(both);
        case disjunction: return fold(either);
        case implication: return either(negate(at(0)), at(1));
        case equivalence: return both(either(negate(at(0)), at(1)), either(negate(at(1)), at(0)));
        case previous:
        case once: return in_the_past(formula, memories_[index], Label::yes, at(0));
        case historically:
            return negate(in_the_past(formula, memories_[index], Label::yes, negate(at(0))));
        case since: return in_the_past(formula, memories_[index], at(0), at(1));
        case rise:
            return both(at(0), in_the_past(formula, memories_[index], Label::yes, negate(at(0))));
        case fall:
            return both(negate(at(0)), in_the_past(formula, memories_[index], Label::yes, at(0)));
        case held: {
            const Label broken = in_the_past(formula, memories_[index], Label::yes, negate(at(0)));
            return both(negate(broken), label_of(frame_ > formula.high));
        }
        case count: return count_of(formula, memories_[index], at(0));
        case next:
        case eventually:
        case always:
        case until:
        case weak_until:
        case release: break;  // truths have no future operators
    }
    return Label::unknown;
}

/// "count(f, D) >= n": yes where f surely began to hold at n of the last frames, no where it did at
/// fewer, however often it may have.
Label TruthEvaluator::count_of(const Formula& formula, Memory& memory, Label f) {
    const auto add = [&](Label began, int sign) {
        if (began == Label::yes) memory.yes += sign;
        if (began != Label::no) memory.possible += sign;
    };
    memory.begins.push_back(std::min(f, negate(std::exchange(memory.before, f))));
    add(memory.begins.back(), 1);
    if (memory.begins.size() > formula.high + std::size_t{1}) {
        add(memory.begins.front(), -1);
        memory.begins.pop_front();
    }
    if (memory.yes >= formula.index) return Label::yes;
    return memory.possible >= formula.index ? Label::unknown : Label::no;
}

/// "f S[a,b] g: max over j in [max(0, k-b), k-a] of min(rho(g, j), min of rho(f, m) over m in (j,
/// k])": yes where g was yes at such a j and f has been yes since, possible where neither was no.
Label TruthEvaluator::in_the_past(const Formula& formula, Memory& memory, Label f, Label g) const {
    memory.delayed.push_back(g);
    if (memory.delayed.size() > formula.low) {
        const std::uint64_t at = frame_ - formula.low;
        if (memory.delayed.front() == Label::yes) memory.last_yes = at;
        if (memory.delayed.front() != Label::no) memory.last_possible = at;
        memory.delayed.pop_front();
    }
    if (f != Label::yes) memory.f_not_yes = frame_;
    if (f == Label::no) memory.f_no = frame_;
    const bool bounded = formula.high != check::kUnbounded && formula.high < frame_;
    const std::uint64_t first = bounded ? frame_ - formula.high : 1;
    if (memory.last_yes >= std::max(first, memory.f_not_yes)) return Label::yes;
    return memory.last_possible >= std::max(first, memory.f_no) ? Label::unknown : Label::no;
}

Label TruthEvaluator::compare(const check::Predicate& predicate) const {
    const double delta = expression(predicate.expression);
    if (std::isnan(delta)) return Label::unknown;
    // Samples are float32, and monitors compare for equality in float32.
    if (predicate.equality())
        return label_of(check::holds(predicate.comparison, static_cast<float>(delta),
                                     predicate.threshold.value));
    return label_of(check::holds(predicate.comparison, delta, predicate.threshold.value64));
}

double TruthEvaluator::expression(const Expr& e) const {
    const auto at = [&](std::size_t i) { return expression(e.arguments[i]); };
    const auto fold = [&](auto combine) {
        double result = at(0);
        for (std::size_t i = 1; i < e.arguments.size(); ++i) {
            const double next = at(i);
            result = std::isnan(result) || std::isnan(next) ? kUnknown : combine(result, next);
        }
        return result;
    };
    switch (e.kind) {
        case Expr::Kind::number: return e.number;
        case Expr::Kind::scalar: return values_[e.index].empty() ? kUnknown : values_[e.index][0];
        case Expr::Kind::distance: return measure(model_.distances[e.index]);
        case Expr::Kind::past: return pasts_[e.index];
        case Expr::Kind::negate: return -at(0);
        case Expr::Kind::add: return at(0) + at(1);
        case Expr::Kind::subtract: return at(0) - at(1);
        case Expr::Kind::multiply: return at(0) * at(1);
        case Expr::Kind::divide: return at(0) / at(1);
        case Expr::Kind::abs: return std::abs(at(0));
        case Expr::Kind::sqrt: return std::sqrt(at(0));
        case Expr::Kind::min: return fold([](double a, double b) { return std::min(a, b); });
        case Expr::Kind::max: return fold([](double a, double b) { return std::max(a, b); });
    }
    return kUnknown;
}

double TruthEvaluator::measure(const check::Distance& distance) const {
    const std::vector<double> point = elements(distance.point, 0);
    if (point.empty()) return kUnknown;
    if (!distance.is_between_points())
        return exact_distance(model_, distance, point).value_or(kUnknown);
    const std::vector<double> other = elements(distance.other, 0);
    return other.empty() ? kUnknown : exact_distance(distance, point, other).value_or(kUnknown);
}

/// Returns a point as it was `ago` frames before; empty where it is missing.
std::vector<double> TruthEvaluator::elements(Index index, std::size_t ago) const {
    const check::Point& point = model_.points[index];
    if (point.is_delayed()) return elements(point.inner, ago + point.steps);
    if (point.is_projected()) {
        const std::vector<double> inner = elements(point.inner, ago);
        return inner.empty() ? inner
                             : check::projected(model_.projections[point.projection], inner);
    }
    std::vector<double> all;
    const auto append = [&](const std::vector<double>& part) {
        all.insert(all.end(), part.begin(), part.end());
        return !part.empty();
    };
    const auto was = [&](Index input) -> const std::vector<double>& {
        return ago == 0 ? values_[input] : earlier_[ago - 1][input];
    };
    if (ago > earlier_.size()) return {};
    const bool there = point.is_joined()
                           ? std::all_of(point.parts.begin(), point.parts.end(),
                                         [&](Index part) { return append(elements(part, ago)); })
                           : std::all_of(point.inputs.begin(), point.inputs.end(),
                                         [&](Index input) { return append(was(input)); });
    return there ? all : std::vector<double>{};
}

GroundTruth ground_truth(const check::Model& model, const std::vector<Index>& labelled) {
    GroundTruth result{model, std::vector<Index>(model.predicates.size(), check::kNone)};
    for (const Index predicate : labelled) {
        check::Input label;
        label.name =
            "truth." +
            model.predicates[predicate].name;  // a dot keeps it apart from names of the spec
        label.type = check::InputType::boolean;
        label.span = model.predicates[predicate].span;
        result.inputs[predicate] = static_cast<Index>(result.model.inputs.size());
        result.model.inputs.push_back(std::move(label));
    }
    for (check::Formula& formula : result.model.formulas) {
        if (formula.kind != check::Formula::Kind::predicate) continue;
        const Index label = result.inputs[formula.index];
        if (label == check::kNone) continue;
        formula.kind = check::Formula::Kind::boolean_input;
        formula.index = label;
    }
    for (check::Let& let : result.model.lets)
        if (let.truth != check::kNone) let.formula = std::exchange(let.truth, check::kNone);
    for (check::Monitor& monitor : result.model.monitors) {
        monitor.formula = monitor.true_formula();
        monitor.truth = check::kNone;
        monitor.calibration.reset();  // the truth needs no shift
        // It is asked about the positions of the monitor that it judges.
        if (monitor.restarts == check::Restarts::when_final)
            monitor.restarts = check::Restarts::on_request;
    }
    result.model.truths.clear();
    return result;
}

std::vector<Index> labelled_predicates(const GroundTruth& truth) {
    std::vector<Index> found;
    for (Index predicate = 0; predicate < truth.inputs.size(); ++predicate)
        if (truth.inputs[predicate] != check::kNone) found.push_back(predicate);
    return found;
}

execute::Sample sample_of(Label label) {
    if (label == Label::unknown) return {};
    return {true, {label == Label::yes ? 1.0F : 0.0F}};
}

}  // namespace etlc::episodes
