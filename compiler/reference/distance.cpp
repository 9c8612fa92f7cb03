#include <algorithm>
#include <cmath>
#include <numeric>

#include "reference/atoms.hpp"

namespace etlc::reference {
namespace {

using check::Aggregation;
using check::Index;
using check::Metric;
using Vector = std::vector<double>;

double dot(const Vector& a, const Vector& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double norm(const Vector& a) {
    return std::sqrt(dot(a, a));
}

Vector difference(const Vector& a, const Vector& b) {
    Vector result(a.size());
    for (std::size_t n = 0; n < a.size(); ++n) result[n] = a[n] - b[n];
    return result;
}

Vector unit(const Vector& a) {
    Vector result = a;
    for (double& element : result) element /= norm(a);
    return result;
}

double l1(const Vector& a) {
    double sum = 0;
    for (const double element : a) sum += std::abs(element);
    return sum;
}

double linf(const Vector& a) {
    double largest = 0;
    for (const double element : a) largest = std::max(largest, std::abs(element));
    return largest;
}

/// Returns 1 - cosine similarity, in [0, 2].
double cosine(const Vector& a, const Vector& b) {
    return std::clamp(1.0 - dot(a, b) / (norm(a) * norm(b)), 0.0, 2.0);
}

/// Returns the angle between a and b in [0, pi], as 2 atan2(|u - v|, |u + v|) of the unit vectors
/// (Kahan): acos of the cosine similarity loses half the digits near 0 and pi.
double angular(const Vector& a, const Vector& b) {
    const Vector u = unit(a);
    const Vector v = unit(b);
    Vector sum(u.size());
    for (std::size_t n = 0; n < u.size(); ++n) sum[n] = u[n] + v[n];
    return 2.0 * std::atan2(norm(difference(u, v)), norm(sum));
}

/// Returns sqrt(d' W d).
double mahalanobis(const Vector& d, const check::Distance& distance) {
    double sum = 0;
    for (std::size_t row = 0; row < d.size(); ++row) {
        if (distance.weights_diagonal) {
            sum += d[row] * distance.weights[row] * d[row];
            continue;
        }
        for (std::size_t column = 0; column < d.size(); ++column)
            sum += d[row] * distance.weights[row * d.size() + column] * d[column];
    }
    return std::sqrt(std::max(sum, 0.0));
}

double between(const check::Distance& distance, const Vector& point, const Vector& target) {
    const Vector d = difference(point, target);
    switch (distance.metric) {
        case Metric::l2: return norm(d);
        case Metric::l2sq: return dot(d, d);
        case Metric::l1: return l1(d);
        case Metric::linf: return linf(d);
        case Metric::cosine: return cosine(point, target);
        case Metric::angular: return angular(point, target);
        case Metric::mahalanobis: return mahalanobis(d, distance);
    }
    return std::nan("");
}

double aggregate(const check::Distance& distance, Vector distances) {
    std::sort(distances.begin(), distances.end());
    switch (distance.aggregation) {
        case Aggregation::min: return distances.front();
        case Aggregation::max: return distances.back();
        case Aggregation::mean:
            return std::accumulate(distances.begin(), distances.end(), 0.0) /
                   static_cast<double>(distances.size());
        case Aggregation::kth:
            return distances[distance.kth - 1];  // "the n-th smallest distance, from 1"
    }
    return std::nan("");
}

/// Returns the embedding, or the scalars of a vector in order; empty where any is missing.
Vector inputs_of(const check::Point& point, const Samples& samples) {
    Vector elements;
    for (const Index input : point.inputs) {
        if (samples[input].empty()) return {};
        elements.insert(elements.end(), samples[input].begin(), samples[input].end());
    }
    return elements;
}

Vector point_of(const check::Model& model, Index index, const std::vector<Samples>& trace,
                std::size_t step);

/// Returns the parts one behind the other; empty where one is missing.
Vector joined(const check::Model& model, const check::Point& point,
              const std::vector<Samples>& trace, std::size_t step) {
    Vector all;
    for (const Index index : point.parts) {
        const Vector part = point_of(model, index, trace, step);
        if (part.empty()) return {};
        all.insert(all.end(), part.begin(), part.end());
    }
    return all;
}

/// Returns f x + g y; empty where one is missing.
Vector sum_of(const check::Model& model, const check::Point& point,
              const std::vector<Samples>& trace, std::size_t step) {
    Vector sum(point.dimension);
    for (std::size_t i = 0; i < point.parts.size(); ++i) {
        const Vector part = point_of(model, point.parts[i], trace, step);
        if (part.empty()) return {};
        for (std::size_t n = 0; n < part.size(); ++n)
            sum[n] += static_cast<double>(point.factors[i]) * part[n];
    }
    return sum;
}

/// Returns P(z) = A (z - m), from the inside out; z@n is z at the step n before, missing where
/// there is none. Empty where an input is missing.
Vector point_of(const check::Model& model, Index index, const std::vector<Samples>& trace,
                std::size_t step) {
    const check::Point& point = model.points[index];
    if (point.is_delayed())
        return step < point.steps ? Vector{}
                                  : point_of(model, point.inner, trace, step - point.steps);
    if (point.is_joined()) return joined(model, point, trace, step);
    if (point.is_sum()) return sum_of(model, point, trace, step);
    if (!point.is_projected()) return inputs_of(point, trace[step]);
    Vector z = point_of(model, point.inner, trace, step);
    if (z.empty()) return {};
    const check::Projection& projection = model.projections[point.projection];
    if (!projection.offset.empty())
        z = difference(z, Vector(projection.offset.begin(), projection.offset.end()));
    Vector result;
    for (std::size_t row = 0; row < projection.rows; ++row) {
        const float* begin = projection.matrix.data() + row * z.size();
        result.push_back(dot(Vector(begin, begin + z.size()), z));
    }
    return result;
}

bool is_zero(const Vector& point) {
    return std::all_of(point.begin(), point.end(), [](double element) { return element == 0; });
}

}  // namespace

Measurement distance(const check::Model& model, const check::Distance& distance,
                     const std::vector<Samples>& trace, std::size_t step) {
    const Vector point = point_of(model, distance.point, trace, step);
    if (point.empty()) return {};
    const bool needs_direction =
        distance.metric == Metric::cosine || distance.metric == Metric::angular;
    if (needs_direction && is_zero(point)) return {};

    if (distance.is_between_points()) {
        const Vector other = point_of(model, distance.other, trace, step);
        if (other.empty() || (needs_direction && is_zero(other))) return {};
        return {between(distance, point, other), 0};
    }
    const check::Target& target = model.targets[distance.target];
    Vector distances;
    for (std::uint32_t row = 0; row < target.rows; ++row) {
        const float* begin = target.values.data() + std::size_t{row} * target.dimension;
        distances.push_back(between(distance, point, Vector(begin, begin + target.dimension)));
    }
    const auto nearest = std::min_element(distances.begin(), distances.end()) - distances.begin();
    return {aggregate(distance, distances), static_cast<std::uint32_t>(nearest)};
}

}  // namespace etlc::reference
