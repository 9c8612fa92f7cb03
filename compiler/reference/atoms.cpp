#include "reference/atoms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace etlc::reference {
namespace {

using check::Expr;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// "a sample with any element not finite, or a scalar outside its declared range, counts as
/// missing". The range is a range of float32 values, so the sample is narrowed first.
bool valid(const check::Input& input, const std::vector<float>& sample) {
    for (const float element : sample) {
        if (!std::isfinite(element)) return false;
        if (input.has_range && (element < input.range.low || element > input.range.high))
            return false;
    }
    return true;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t n = 0; n < a.size(); ++n)
        if (a[n] != b[n] || std::signbit(a[n]) != std::signbit(b[n])) return false;
    return true;
}

/// "The first N equal samples in a row count. Every later one counts as missing, until a different
/// sample comes": returns whether the last is a later one. `seen`: the valid samples so far.
bool stale(const check::Input& input, const std::vector<std::vector<float>>& seen) {
    if (input.stale_after == 0 || seen.size() <= input.stale_after) return false;
    for (std::size_t back = 1; back <= input.stale_after; ++back)
        if (!same_bits(seen.back(), seen[seen.size() - 1 - back])) return false;
    return true;
}

double past(const check::Model& model, const Expr& expr, const std::vector<Samples>& trace,
            std::size_t step);

/// Evaluates in double; a NaN anywhere makes the whole expression NaN, also through min and max.
double evaluate(const check::Model& model, const Expr& expr, const std::vector<Samples>& trace,
                std::size_t step) {
    if (expr.kind == Expr::Kind::past) return past(model, expr, trace, step);
    std::vector<double> a;
    for (const Expr& argument : expr.arguments) {
        a.push_back(evaluate(model, argument, trace, step));
        if (std::isnan(a.back())) return kUnknown;
    }
    const Samples& samples = trace[step];
    switch (expr.kind) {
        case Expr::Kind::number: return expr.number32;
        case Expr::Kind::scalar:
            return samples[expr.index].empty() ? kUnknown : samples[expr.index][0];
        case Expr::Kind::distance:
            return distance(model, model.distances[expr.index], trace, step)
                .delta.value_or(kUnknown);
        case Expr::Kind::past: break;
        case Expr::Kind::negate: return -a[0];
        case Expr::Kind::add: return a[0] + a[1];
        case Expr::Kind::subtract: return a[0] - a[1];
        case Expr::Kind::multiply: return a[0] * a[1];
        case Expr::Kind::divide: return a[0] / a[1];
        case Expr::Kind::abs: return std::abs(a[0]);
        case Expr::Kind::sqrt: return std::sqrt(a[0]);
        case Expr::Kind::min: return *std::min_element(a.begin(), a.end());
        case Expr::Kind::max: return *std::max_element(a.begin(), a.end());
    }
    return kUnknown;
}

/// "e@n at step i is the value of e at step i - n"; "mean, min and max of w steps at step i are
/// over the values of e at steps i - w + 1 to i"; missing where one of these is.
double past(const check::Model& model, const Expr& expr, const std::vector<Samples>& trace,
            std::size_t step) {
    using Kind = check::Past::Kind;
    const check::Past& how = model.pasts[expr.index];
    const std::size_t first = how.kind == Kind::ago ? how.steps : how.steps - 1;
    if (step < first) return kUnknown;
    if (how.kind == Kind::ago) return evaluate(model, expr.arguments[0], trace, step - how.steps);
    std::vector<double> values;
    for (std::size_t j = step - first; j <= step; ++j) {
        values.push_back(evaluate(model, expr.arguments[0], trace, j));
        if (std::isnan(values.back())) return kUnknown;
    }
    if (how.kind == Kind::min) return *std::min_element(values.begin(), values.end());
    if (how.kind == Kind::max) return *std::max_element(values.begin(), values.end());
    return std::accumulate(values.begin(), values.end(), 0.0) / how.steps;
}

}  // namespace

std::vector<Samples> accept(const check::Model& model, const Trace& trace) {
    std::vector<Samples> result;
    std::vector<std::vector<float>> last(model.inputs.size());  // the last present sample
    std::vector<std::uint32_t> held(model.inputs.size(),
                                    0);  // consecutive steps that it has replaced
    std::vector<std::vector<std::vector<float>>> seen(model.inputs.size());  // the valid samples
    for (const Step& step : trace) {
        Samples samples(model.inputs.size());
        for (std::size_t n = 0; n < model.inputs.size(); ++n) {
            for (const double element : step[n]) samples[n].push_back(static_cast<float>(element));
            const bool is_valid = !samples[n].empty() && valid(model.inputs[n], samples[n]);
            if (is_valid) seen[n].push_back(samples[n]);
            if (is_valid && !stale(model.inputs[n], seen[n])) {
                last[n] = samples[n];
                held[n] = 0;
            } else {
                // "where a sample is missing, the last one present stands in for at most N steps in
                // a row"
                samples[n].clear();
                if (held[n] < model.inputs[n].hold) {
                    ++held[n];
                    samples[n] = last[n];
                }
            }
        }
        result.push_back(std::move(samples));
    }
    return result;
}

Measurement measure(const check::Model& model, const check::Predicate& predicate,
                    const std::vector<Samples>& trace, std::size_t step) {
    if (predicate.plain_distance())
        return distance(model, model.distances[predicate.expression.index], trace, step);
    const double delta = evaluate(model, predicate.expression, trace, step);
    if (std::isnan(delta)) return {};
    return {delta, 0};
}

}  // namespace etlc::reference
