#include "episodes/truth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "check/points/points.hpp"

namespace etlc::episodes {

// ---- distances in double ------------------------------------------------------------------------

namespace {

using check::Metric;

double length(const double* v, std::size_t n) {
    double square = 0;
    for (std::size_t i = 0; i < n; ++i) square += v[i] * v[i];
    return std::sqrt(square);
}

/// |u - v|^2 and |u + v|^2 of the unit vectors along z and g.
struct Directions {
    double apart = 0;
    double along = 0;
};

template <class Number>
Directions directions(const std::vector<double>& z, double z_length, const Number* g) {
    const std::vector<double> row(g, g + z.size());
    const double g_length = length(row.data(), row.size());
    Directions result;
    for (std::size_t i = 0; i < z.size(); ++i) {
        const double u = z[i] / z_length;
        const double v = row[i] / g_length;
        result.apart += (u - v) * (u - v);
        result.along += (u + v) * (u + v);
    }
    return result;
}

/// (z - g)^T W (z - g)
template <class Number>
double quadratic_form(const check::Distance& distance, const std::vector<double>& z,
                      const Number* g) {
    const std::size_t n = z.size();
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double difference = z[i] - g[i];
        if (distance.weights_diagonal) {
            sum += distance.weights[i] * difference * difference;
            continue;
        }
        double row = 0;
        for (std::size_t j = 0; j < n; ++j) row += distance.weights[i * n + j] * (z[j] - g[j]);
        sum += difference * row;
    }
    return std::max(sum, 0.0);  // W is positive definite
}

template <class Number>
double to_row(const check::Distance& distance, const std::vector<double>& z, double z_length,
              const Number* g) {
    double sum = 0;
    double squares = 0;
    double greatest = 0;
    for (std::size_t i = 0; i < z.size(); ++i) {
        const double difference = std::abs(z[i] - g[i]);
        sum += difference;
        squares += difference * difference;
        greatest = std::max(greatest, difference);
    }
    switch (distance.metric) {
        case Metric::l1: return sum;
        case Metric::l2: return std::sqrt(squares);
        case Metric::l2sq: return squares;
        case Metric::linf: return greatest;
        case Metric::cosine:
            return std::min(2.0, directions(z, z_length, g).apart / 2);  // 1 - u.v = |u - v|^2 / 2
        case Metric::angular: {
            const Directions d = directions(z, z_length, g);
            return 2 * std::atan2(std::sqrt(d.apart), std::sqrt(d.along));
        }
        case Metric::mahalanobis: return std::sqrt(quadratic_form(distance, z, g));
    }
    return std::nan("");
}

}  // namespace

double aggregate(const check::Distance& distance, std::vector<double> rows) {
    switch (distance.aggregation) {
        case check::Aggregation::min: return *std::min_element(rows.begin(), rows.end());
        case check::Aggregation::max: return *std::max_element(rows.begin(), rows.end());
        case check::Aggregation::mean:
            return std::accumulate(rows.begin(), rows.end(), 0.0) /
                   static_cast<double>(rows.size());
        case check::Aggregation::kth: break;
    }
    std::nth_element(rows.begin(), rows.begin() + (distance.kth - 1), rows.end());
    return rows[distance.kth - 1];
}

std::optional<double> exact_distance(const check::Model& model, const check::Distance& distance,
                                     const std::vector<double>& point) {
    const check::Target& target = model.targets[distance.target];
    const double z_length =
        check::is_of_directions(distance.metric) ? length(point.data(), point.size()) : 1;
    if (z_length == 0) return std::nullopt;
    std::vector<double> rows;
    for (std::size_t k = 0; k < target.rows; ++k)
        rows.push_back(
            to_row(distance, point, z_length, target.values.data() + k * target.dimension));
    return aggregate(distance, std::move(rows));
}

std::optional<double> exact_distance(const check::Distance& distance,
                                     const std::vector<double>& point,
                                     const std::vector<double>& other) {
    const bool directed = check::is_of_directions(distance.metric);
    const double z_length = directed ? length(point.data(), point.size()) : 1;
    if (z_length == 0 || (directed && length(other.data(), other.size()) == 0)) return std::nullopt;
    return to_row(distance, point, z_length, other.data());
}

// ---- numbers that earlier steps have a part in --------------------------------------------------

namespace {

using Kind = check::Past::Kind;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Adds to a sum without rounding: it is kept in parts whose bits do not overlap (Shewchuk 1997).
void add_exactly(std::vector<double>& parts, double x) {
    std::size_t kept = 0;
    for (const double part : parts) {
        const double sum = x + part;
        const double of_part = sum - x;
        const double rest = (x - (sum - of_part)) + (part - of_part);
        if (rest != 0) parts[kept++] = rest;
        x = sum;
    }
    parts.resize(kept);
    if (x != 0) parts.push_back(x);
}

}  // namespace

void PastValues::reset() {
    values_.clear();
    candidates_.clear();
    sum_.clear();
    frame_ = 0;
    above_ = 0;
    below_ = 0;
}

double PastValues::push(double value) {
    if (past_->kind == Kind::ago) {
        values_.push_back(value);
        if (values_.size() <= past_->steps) return kUnknown;
        const double ago = values_.front();
        values_.pop_front();
        return ago;
    }
    if (std::isnan(value)) {
        reset();
        return kUnknown;
    }
    if (past_->kind != Kind::mean) return extreme(value);
    values_.push_back(value);
    add(value, 1);
    if (values_.size() > past_->steps) {
        add(values_.front(), -1);
        values_.pop_front();
    }
    return values_.size() == past_->steps ? mean() : kUnknown;
}

void PastValues::add(double value, double sign) {
    if (!std::isinf(value)) return add_exactly(sum_, sign * value);
    std::size_t& count = value > 0 ? above_ : below_;
    count = sign > 0 ? count + 1 : count - 1;
}

double PastValues::mean() const {
    const double infinity = std::numeric_limits<double>::infinity();
    if (above_ > 0 && below_ > 0) return kUnknown;
    if (above_ > 0 || below_ > 0) return above_ > 0 ? infinity : -infinity;
    return std::accumulate(sum_.begin(), sum_.end(), 0.0) / past_->steps;
}

double PastValues::extreme(double value) {
    const auto outdone = [&](double other) {
        return past_->kind == Kind::min ? value <= other : value >= other;
    };
    while (!candidates_.empty() && outdone(candidates_.back().second)) candidates_.pop_back();
    candidates_.emplace_back(frame_, value);
    if (candidates_.front().first + past_->steps <= frame_) candidates_.pop_front();
    ++frame_;
    return frame_ >= past_->steps ? candidates_.front().second : kUnknown;
}

// ---- truths -------------------------------------------------------------------------------------

namespace {

using check::Expr;
using check::Formula;
using check::Input;

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

bool is_atom(const Formula& formula) {
    return formula.kind == Formula::Kind::predicate || formula.kind == Formula::Kind::boolean_input;
}

/// Compiles a sliding monitor for each formula, over a bool input for each formula that is an atom.
/// A host has room for any of them.
Compiled over_atoms(const check::Model& model, const std::vector<Index>& formulas) {
    check::Model result;
    result.formulas = model.formulas;
    for (Index f = 0; f < result.formulas.size(); ++f) {
        Input& input = result.inputs.emplace_back();
        input.name = fmt::format("atom_{}", f);
        input.type = check::InputType::boolean;
        Formula& formula = result.formulas[f];
        if (!is_atom(formula)) continue;
        formula.kind = Formula::Kind::boolean_input;
        formula.index = f;
    }
    for (const Index formula : formulas) {
        check::Monitor& monitor = result.monitors.emplace_back();
        monitor.name = fmt::format("truth_{}", formula);
        monitor.formula = formula;
        monitor.sliding = true;
    }
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
    diag::Sink sink;
    return *compile(std::move(result), {{kMost, kMost, kMost, kMost}, check::Values::boolean},
                    sink);
}

}  // namespace

TruthEvaluator::TruthEvaluator(const check::Model& model, const std::vector<Index>& formulas)
    : model_(model), formulas_(formulas) {
    std::set<Index> atoms;
    std::set<Index> inputs;
    std::set<Index> pasts;
    for (const Index formula : formulas)
        for (const Index part : check::parts_of(model, formula))
            if (is_atom(model.formulas[part])) atoms.insert(part);
    for (const Index atom : atoms) {
        const Formula& formula = model.formulas[atom];
        if (formula.kind == Formula::Kind::boolean_input) {
            inputs.insert(formula.index);
            continue;
        }
        const check::Predicate& predicate = model.predicates[formula.index];
        inputs.insert(predicate.inputs.begin(), predicate.inputs.end());
        check::for_each(predicate.expression, [&](const Expr& e) {
            if (e.kind == Expr::Kind::past) pasts.insert(e.index);
        });
        check::for_each_distance(predicate.expression, [&](Index d) {
            for (const Index point : {model.distances[d].point, model.distances[d].other})
                if (point != check::kNone)
                    longest_delay_ = std::max(longest_delay_, check::longest_delay(model, point));
        });
    }
    atoms_.assign(atoms.begin(), atoms.end());
    inputs_.assign(inputs.begin(), inputs.end());
    read_pasts_.assign(pasts.begin(), pasts.end());
    for (const Index past : read_pasts_) past_values_.emplace_back(model.pasts[past]);
    reset();
}

void TruthEvaluator::reset() {
    has_begun_ = false;
    if (evaluator_) evaluator_->reset();
    labels_.assign(model_.formulas.size(), Label::unknown);
    values_.assign(model_.inputs.size(), {});
    earlier_.clear();
    held_.assign(model_.inputs.size(), {});
    ages_.assign(model_.inputs.size(), 0);
    freshness_.assign(model_.inputs.size(), {});
    for (PastValues& past : past_values_) past.reset();
    pasts_.assign(model_.pasts.size(), kUnknown);
}

void TruthEvaluator::step(const Frame& frame) {
    if (!evaluator_ && !formulas_.empty()) {
        temporal_ = over_atoms(model_, formulas_);
        evaluator_ = std::make_unique<execute::Evaluator>(temporal_.plan);
        samples_.resize(model_.formulas.size());
    }
    if (longest_delay_ > 0 && has_begun_) {
        earlier_.push_front(values_);
        if (earlier_.size() > longest_delay_) earlier_.pop_back();
    }
    has_begun_ = true;
    take_inputs(frame);
    take_pasts();
    take_atoms();
}

void TruthEvaluator::take_atoms() {
    if (!evaluator_) return;
    for (const Index atom : atoms_) {
        const Formula& formula = model_.formulas[atom];
        Label label = Label::unknown;
        if (formula.kind == Formula::Kind::predicate)
            label = compare(model_.predicates[formula.index]);
        else if (!values_[formula.index].empty())
            label = label_of(values_[formula.index][0] != 0);
        samples_[atom] = sample_of(label);
    }
    const std::vector<etlmon::Verdict>& verdicts = evaluator_->step(samples_);
    for (std::size_t m = 0; m < verdicts.size(); ++m)
        labels_[formulas_[temporal_.plan.monitors[m].index]] = label_of(verdicts[m]);
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
    if (point.is_sum()) {
        all.resize(point.dimension);
        for (std::size_t i = 0; i < point.parts.size(); ++i) {
            const std::vector<double> part = elements(point.parts[i], ago);
            if (part.empty()) return {};
            for (std::size_t n = 0; n < part.size(); ++n)
                all[n] += static_cast<double>(point.factors[i]) * part[n];
        }
        return all;
    }
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
        const check::Threshold& threshold = model.predicates[formula.index].threshold;
        if (label == check::kNone && threshold.origin == check::ThresholdOrigin::normal)
            formula.kind = check::Formula::Kind::constant_true;
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
    result.model.drifts.clear();
    return result;
}

std::vector<Index> labelled_predicates(const GroundTruth& truth) {
    std::vector<Index> found;
    for (Index predicate = 0; predicate < truth.inputs.size(); ++predicate)
        if (truth.inputs[predicate] != check::kNone) found.push_back(predicate);
    return found;
}

Label label_of(const etlmon::Verdict& verdict) {
    if (verdict.satisfied()) return Label::yes;
    return verdict.violated() ? Label::no : Label::unknown;
}

execute::Sample sample_of(Label label) {
    if (label == Label::unknown) return {};
    return {true, {label == Label::yes ? 1.0F : 0.0F}};
}

}  // namespace etlc::episodes
