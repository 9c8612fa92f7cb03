#include "episodes/exact_distance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace etlc::episodes {

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

}  // namespace etlc::episodes
