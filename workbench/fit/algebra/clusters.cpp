#include "fit/algebra/clusters.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "episodes/bootstrap.hpp"

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

/// A run of Lloyd's rounds. A centre is the mean of a set of points, represented by its products
/// with all points.
class Lloyd {
public:
    Lloyd(const Points& points, const Members& members, const Members& seeds)
        : points_(points),
          members_(members),
          nearest_(members.size(), kNobody),
          squared_(static_cast<Index>(members.size())),
          mean_of_(members.size(), kNobody),
          alone_(seeds),
          sums_(points.size(), static_cast<Index>(seeds.size())),
          counts_(sums_.cols()),
          squares_(sums_.cols()) {
        for (Index c = 0; c < sums_.cols(); ++c) put_alone(c, seeds[static_cast<std::size_t>(c)]);
        assign();
    }

    /// Whether no member changes its centre any more.
    bool is_done() const { return is_done_; }

    // A round: begins, moves each member to the mean of its nearest centre, and ends.

    void begin_round() {
        for (Index c = 0; c < counts_.size(); ++c)
            if (alone_[static_cast<std::size_t>(c)] != kNobody) clear(c);
    }

    void move(std::size_t member) {
        if (mean_of_[member] == nearest_[member]) return;
        if (mean_of_[member] != kNobody) add(mean_of_[member], -1, members_[member]);
        add(nearest_[member], 1, members_[member]);
        mean_of_[member] = nearest_[member];
    }

    void end_round() {
        fill_empty();
        is_done_ = !assign();
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

    /// Sums for all points, also those that are no members: without gaps it takes half the time.
    void add(Index centre, double sign, Index point) {
        sums_.col(centre) += sign * points_.products().col(point);
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

    /// Moves each centre without a member to the member that is furthest from its own centre.
    void fill_empty() {
        squares_.setZero();
        for (Index i = 0; i < squared_.size(); ++i) {
            const Index c = mean_of_[static_cast<std::size_t>(i)];
            const Index point = members_[static_cast<std::size_t>(i)];
            squares_(c) += sums_(point, c) / (counts_(c) * counts_(c));
        }
        for (Index c = 0; c < counts_.size(); ++c) {
            if (counts_(c) > 0) continue;
            Index furthest = 0;
            squared_.maxCoeff(&furthest);
            squared_(furthest) = 0;
            put_alone(c, members_[static_cast<std::size_t>(furthest)]);
        }
    }

    /// Assigns members to their nearest centres, of equally near ones the first; returns whether
    /// any changed.
    bool assign() {
        const std::vector<Index> before = nearest_;
        squared_.setConstant(kInfinity);
        for (Index c = 0; c < counts_.size(); ++c) {  // in the order of memory
            const double* const sums = sums_.col(c).data();
            for (Index i = 0; i < squared_.size(); ++i) {
                const Index point = members_[static_cast<std::size_t>(i)];
                const double square = squares_(c) - 2 * (sums[point] / counts_(c));
                const bool is_nearer = square < squared_(i);
                squared_(i) = is_nearer ? square : squared_(i);
                Index& nearest = nearest_[static_cast<std::size_t>(i)];
                nearest = is_nearer ? c : nearest;
            }
        }
        for (Index i = 0; i < squared_.size(); ++i) {
            const Index point = members_[static_cast<std::size_t>(i)];
            squared_(i) = std::max(0.0, points_.products()(point, point) + squared_(i));
        }
        return nearest_ != before;
    }

    const Points& points_;
    const Members& members_;
    std::vector<Index> nearest_;  ///< centre of each member
    Vector squared_;              ///< per member, the squared distance to that centre
    std::vector<Index> mean_of_;  ///< per member, the centre whose mean includes it
    std::vector<Index> alone_;    ///< per centre, the point that it is; kNobody for a mean
    Matrix sums_;     ///< per point and centre, the product with the sum of the centre's points
    Vector counts_;   ///< number of these points
    Vector squares_;  ///< per centre, the product with itself
    bool is_done_ = false;
};

/// Runs all until they are done, at most kMostRounds. Each product is read once a round for all of
/// them: reading takes longer than adding.
void run(std::vector<Lloyd>& all, std::size_t members) {
    std::vector<Lloyd*> running;
    for (Lloyd& one : all) running.push_back(&one);
    for (int round = 0; round < kMostRounds && !running.empty(); ++round) {
        for (Lloyd* one : running) one->begin_round();
        for (std::size_t i = 0; i < members; ++i)
            for (Lloyd* one : running) one->move(i);
        for (Lloyd* one : running) one->end_round();
        std::erase_if(running, [](const Lloyd* one) { return one->is_done(); });
    }
}

}  // namespace

Points::Points(Matrix points, unsigned jobs)
    : middle_(points.rowwise().mean()), centred_(std::move(points)) {
    centred_.colwise() -= middle_;
    products_ = Matrix::Zero(size(), size());
    add_products(centred_.transpose(), 1, products_, jobs);
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
    episodes::Random random(kSeed);
    std::vector<Lloyd> starts;
    for (int start = 0; start < kStarts; ++start) {
        const auto first = seeds(points, members, k, random);
        if (!first) return std::nullopt;
        starts.emplace_back(points, members, *first);
    }
    run(starts, members.size());
    return std::min_element(
               starts.begin(), starts.end(),
               [](const Lloyd& a, const Lloyd& b) { return a.inertia() < b.inertia(); })
        ->centres();
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
