#include "fit/algebra/clusters.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "episodes/random.hpp"
#include "fit/algebra/dense.hpp"

namespace etlc::fit {

namespace {

using Eigen::Index;

constexpr int kMostRounds = 100;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// k-means++: draws each centre from the members by squared distance to the centres so far. Returns
/// nothing where all members are centres already.
std::optional<Members> seeds(const Points& points, const Members& members, Index k,
                             episodes::Random& random) {
    Members drawn;
    Vector nearest = Vector::Constant(static_cast<Index>(members.size()), kInfinity);
    auto next = static_cast<Index>(random.below(members.size()));
    for (;;) {
        drawn.push_back(members[static_cast<std::size_t>(next)]);
        if (static_cast<Index>(drawn.size()) == k) return drawn;
        for (Index i = 0; i < nearest.size(); ++i)
            nearest(i) = std::min(
                nearest(i),
                points.squared_distance(members[static_cast<std::size_t>(i)], drawn.back()));
        const double total = nearest.sum();
        if (!(total > 0)) return std::nullopt;
        double left = random.unit() * total;
        for (next = 0; next + 1 < nearest.size(); ++next) {
            left -= nearest(next);
            if (left < 0) break;
        }
        while (nearest(next) == 0) next = next == 0 ? nearest.size() - 1 : next - 1;
    }
}

/// Lloyd's rounds. A centre is the mean of a set of points, represented by its products with the
/// members.
class Lloyd {
public:
    Lloyd(const Points& points, const Members& members, const Members& seeds)
        : points_(points),
          members_(members),
          nearest_(members.size(), kNobody),
          squared_(static_cast<Index>(members.size())),
          mean_of_(members.size(), kNobody),
          alone_(seeds),
          sums_(squared_.size(), static_cast<Index>(seeds.size())),
          counts_(sums_.cols()),
          squares_(sums_.cols()) {
        for (Index c = 0; c < sums_.cols(); ++c) put_alone(c, seeds[static_cast<std::size_t>(c)]);
        assign();
    }

    /// Repeats until no member changes its centre.
    void run() {
        for (int round = 0; round < kMostRounds; ++round) {
            take_means();
            if (!assign()) return;
        }
    }

    double inertia() const { return squared_.sum(); }

    /// Returns the centres, that of the largest cluster first.
    Matrix centres() const {
        Matrix found = Matrix::Zero(points_.centred().rows(), counts_.size());
        std::vector<std::size_t> sizes(alone_.size());
        for (std::size_t i = 0; i < members_.size(); ++i) {
            if (mean_of_[i] != kNobody)
                found.col(mean_of_[i]) += points_.centred().col(members_[i]);
            ++sizes[static_cast<std::size_t>(nearest_[i])];
        }
        std::vector<Index> order(alone_.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
            return sizes[static_cast<std::size_t>(a)] > sizes[static_cast<std::size_t>(b)];
        });
        Matrix result(found.rows(), found.cols());
        for (Index c = 0; c < result.cols(); ++c) {
            const Index from = order[static_cast<std::size_t>(c)];
            const Index alone = alone_[static_cast<std::size_t>(from)];
            result.col(c) = alone != kNobody ? points_[alone]
                                             : found.col(from) / counts_(from) + points_.middle();
        }
        return result;
    }

private:
    static constexpr Index kNobody = -1;

    void add(Index centre, double sign, Index point) {
        const auto products = points_.products().col(point);
        for (Index i = 0; i < squared_.size(); ++i)
            sums_(i, centre) += sign * products(members_[static_cast<std::size_t>(i)]);
        counts_(centre) += sign;
    }

    void clear(Index centre) {
        sums_.col(centre).setZero();
        counts_(centre) = 0;
        alone_[static_cast<std::size_t>(centre)] = kNobody;
    }

    /// Moves the centre to this point.
    void put_alone(Index centre, Index point) {
        clear(centre);
        add(centre, 1, point);
        squares_(centre) = points_.products()(point, point);
        alone_[static_cast<std::size_t>(centre)] = point;
    }

    /// Moves each centre to the mean of its nearest members; one without any moves to the member
    /// that is furthest from its own centre.
    void take_means() {
        for (Index c = 0; c < counts_.size(); ++c)
            if (alone_[static_cast<std::size_t>(c)] != kNobody) clear(c);
        for (std::size_t i = 0; i < members_.size(); ++i) {
            if (mean_of_[i] == nearest_[i]) continue;
            if (mean_of_[i] != kNobody) add(mean_of_[i], -1, members_[i]);
            add(nearest_[i], 1, members_[i]);
            mean_of_[i] = nearest_[i];
        }
        squares_.setZero();
        for (Index i = 0; i < squared_.size(); ++i) {
            const Index c = mean_of_[static_cast<std::size_t>(i)];
            squares_(c) += sums_(i, c) / (counts_(c) * counts_(c));
        }
        for (Index c = 0; c < counts_.size(); ++c) {
            if (counts_(c) > 0) continue;
            Index furthest = 0;
            squared_.maxCoeff(&furthest);
            squared_(furthest) = 0;
            put_alone(c, members_[static_cast<std::size_t>(furthest)]);
        }
    }

    /// Assigns members to their nearest centres; returns whether any changed.
    bool assign() {
        bool changed = false;
        for (Index i = 0; i < squared_.size(); ++i) {
            const Index point = members_[static_cast<std::size_t>(i)];
            Index best = 0;
            const double square =
                (squares_ - 2 * sums_.row(i).transpose().cwiseQuotient(counts_)).minCoeff(&best);
            squared_(i) = std::max(0.0, points_.products()(point, point) + square);
            Index& nearest = nearest_[static_cast<std::size_t>(i)];
            changed = changed || nearest != best;
            nearest = best;
        }
        return changed;
    }

    const Points& points_;
    const Members& members_;
    std::vector<Index> nearest_;  ///< centre of each member
    Vector squared_;              ///< per member, the squared distance to that centre
    std::vector<Index> mean_of_;  ///< per member, the centre whose mean includes it
    std::vector<Index> alone_;    ///< per centre, the point that it is; kNobody for a mean
    Matrix sums_;     ///< per member and centre, the product with the sum of the centre's points
    Vector counts_;   ///< number of these points
    Vector squares_;  ///< per centre, the product with itself
};

}  // namespace

Points::Points(const Matrix& points)
    : middle_(points.rowwise().mean()), centred_(points.colwise() - middle_) {
    products_ = Matrix::Zero(size(), size());
    add_products(centred_.transpose(), 1, products_);
    products_.triangularView<Eigen::StrictlyUpper>() = products_.transpose();
}

double Points::squared_distance(Index i, Index j) const {
    constexpr double kFewDigits =
        1e-8;  // below this share cancellation is severe: subtract the points instead
    const double all = products_(i, i) + products_(j, j);
    const double squared = all - 2 * products_(i, j);
    return squared > kFewDigits * all ? squared : (centred_.col(i) - centred_.col(j)).squaredNorm();
}

std::optional<Matrix> k_means(const Points& points, const Members& members, Index k) {
    constexpr std::uint64_t kSeed = 2026;
    if (static_cast<Index>(members.size()) < k) return std::nullopt;
    std::optional<Matrix> best;
    double least = kInfinity;
    episodes::Random random(kSeed);
    for (int start = 0; start < kStarts; ++start) {
        const auto first = seeds(points, members, k, random);
        if (!first) return std::nullopt;
        Lloyd lloyd(points, members, *first);
        lloyd.run();
        if (best && !(lloyd.inertia() < least)) continue;
        best = lloyd.centres();
        least = lloyd.inertia();
    }
    return best;
}

std::vector<std::size_t> nearest_points(const Points& points, const Members& members,
                                        const Matrix& centres) {
    std::vector<std::size_t> result;
    for (Index c = 0; c < centres.cols(); ++c) {
        const Vector products = points.centred().transpose() * (centres.col(c) - points.middle());
        double least = kInfinity;
        std::optional<std::size_t> nearest;
        for (std::size_t i = 0; i < members.size(); ++i) {
            const Index point = members[i];
            const double squared = points.products()(point, point) - 2 * products(point);
            if (nearest && !(squared < least)) continue;
            if (std::find(result.begin(), result.end(), i) != result.end()) continue;
            least = squared;
            nearest = i;
        }
        result.push_back(*nearest);
    }
    return result;
}

}  // namespace etlc::fit
