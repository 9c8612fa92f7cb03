#include "fit/algebra/moments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace etlc::fit {

namespace {

/// Returns the factor of v v^T, v being the difference of two means, that the scatter of their
/// union has beyond the sum of both scatters.
double between(std::uint64_t a, std::uint64_t b) {
    const auto n = static_cast<double>(a);
    const auto m = static_cast<double>(b);
    return n + m > 0 ? n * m / (n + m) : 0;
}

}  // namespace

Mean Mean::of(const Eigen::Ref<const Matrix>& frames) {
    if (frames.cols() == 0) return none(frames.rows());
    return {static_cast<std::uint64_t>(frames.cols()), frames.rowwise().mean()};
}

void Mean::merge(const Mean& other) {
    if (other.n == 0) return;
    n += other.n;
    mean += static_cast<double>(other.n) / static_cast<double>(n) * (other.mean - mean);
}

void Scatter::set(Eigen::Ref<Matrix> frames) {
    all = Mean::of(frames);
    lower.setZero(frames.rows(), frames.rows());
    frames.colwise() -= all.mean;
    add_products(frames, 1, lower);
}

void Scatter::merge(const Scatter& other) {
    lower.triangularView<Eigen::Lower>() += other.lower;
    add_products(other.all.mean - all.mean, between(all.n, other.all.n), lower);
    all.merge(other.all);
}

void Moments::merge(const Moments& other) {
    merge({this}, {&other});
}

void Moments::merge(const std::vector<Moments*>& all, const std::vector<const Moments*>& more) {
    std::map<std::pair<const Scatter*, const Scatter*>, std::vector<std::size_t>> sharing;
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t c = 0; c < kClasses; ++c) all[i]->classes_[c].merge(more[i]->classes_[c]);
        if (more[i]->scatter_ != nullptr)
            sharing[{all[i]->scatter_.get(), more[i]->scatter_.get()}].push_back(i);
    }
    for (const auto& [pair, members] : sharing) {
        std::shared_ptr<Scatter>& first = all[members.front()]->scatter_;
        if (first == nullptr) {
            first = more[members.front()]->scatter_;
        } else {
            if (first.use_count() > static_cast<long>(members.size()))
                first = std::make_shared<Scatter>(*first);
            first->merge(*pair.second);
        }
        for (const std::size_t i : members) all[i]->scatter_ = first;
    }
}

Matrix Moments::within() const {
    constexpr double kRounding = 1e-13;
    Matrix result = scatter_->lower;
    const Vector all = result.diagonal();
    add_products(mean(1) - mean(0), -between(frames(0), frames(1)), result);
    for (Eigen::Index i = 0; i < all.size(); ++i) {
        if (result(i, i) > kRounding * all(i)) continue;
        result.row(i).setZero();
        result.col(i).setZero();
    }
    return result;
}

double Moments::within_along(const Vector& direction) const {
    const double all = direction.dot(scatter_->lower.selfadjointView<Eigen::Lower>() * direction);
    const double apart = direction.dot(mean(1) - mean(0));
    return std::max(0.0, all - between(frames(0), frames(1)) * apart * apart);
}

std::uint64_t Moments::constants() const {
    return static_cast<std::uint64_t>((scatter_->lower.diagonal().array() == 0).count());
}

Moments Moments::mapped(const Affine& map) const {
    Moments result(map.a.rows());
    for (std::size_t c = 0; c < kClasses; ++c)
        result.classes_[c] = {classes_[c].n, map.a * (classes_[c].mean - map.offset)};
    if (scatter_ != nullptr)
        result.scatter_ = std::make_shared<Scatter>(
            Scatter{{scatter_->all.n, map.a * (scatter_->all.mean - map.offset)},
                    map.a * scatter_->lower.selfadjointView<Eigen::Lower>() * map.a.transpose()});
    return result;
}

namespace {

/// Makes the element of greatest magnitude positive; of equal ones, the first.
Vector with_sign(const Vector& direction) {
    Eigen::Index greatest = 0;
    direction.cwiseAbs().maxCoeff(&greatest);
    return direction(greatest) < 0 ? Vector(-direction) : direction;
}

bool has_both(const Moments& moments) {
    return moments.frames(0) > 0 && moments.frames(kHolds) > 0;
}

/// Returns the distance of the class means along a direction, in standard deviations within
/// classes.
double separation(const Moments& moments, const Vector& direction) {
    const double apart = direction.dot(moments.mean(kHolds) - moments.mean(0));
    const double variance = moments.within_along(direction) / static_cast<double>(moments.frames());
    return apart / std::sqrt(variance + std::numeric_limits<double>::min());
}

void shrink(Matrix& covariance, double shrinkage) {
    const double mean = covariance.trace() / static_cast<double>(covariance.rows());
    covariance *= 1 - shrinkage;
    covariance.diagonal().array() += shrinkage * mean;
}

/// `within`: the covariance within classes. `room`: memory for another such matrix.
std::optional<Affine> discriminant(const Moments& moments, const Matrix& within, double shrinkage,
                                   Matrix& room) {
    if (!has_both(moments)) return std::nullopt;
    room = within;
    shrink(room, shrinkage);
    auto cholesky = Cholesky::of(std::move(room));
    const Vector apart = moments.mean(kHolds) - moments.mean(0);
    if (!cholesky || apart.isZero(0)) return std::nullopt;
    const Vector direction = cholesky->solve(apart);
    room = std::move(*cholesky).release();
    return Affine{direction.transpose() / std::sqrt(direction.dot(apart)),
                  (moments.mean(0) + moments.mean(kHolds)) / 2};
}

}  // namespace

Matrix covariance(const Moments& moments) {
    Matrix result = moments.within();
    result /= static_cast<double>(moments.frames(kHolds)) - 1;
    return result;
}

Variances greatest_variances(const Moments& moments, Eigen::Index r) {
    const Matrix all = covariance(moments);
    const Eigen::Index count = std::min(all.rows(), std::max(r, kLeastVariances));
    return {moments.mean(kHolds), greatest_eigenpairs(all, count), all.trace()};
}

Components principal_components(const Variances& variances, Eigen::Index r, bool whitened) {
    constexpr double kNoVariance = 1e-12;  // relative: what rounding leaves of float32 data
    const Vector greatest = variances.greatest.values.head(r);
    Components result;
    result.rank = (greatest.array() > kNoVariance * greatest(0)).count();
    result.map = {Matrix(r, variances.mean.size()), variances.mean};
    for (Eigen::Index i = 0; i < r; ++i) {
        const double length = whitened ? std::sqrt(greatest(i)) : 1;
        result.map.a.row(i) = with_sign(variances.greatest.vectors.col(i)).transpose() / length;
    }
    result.explained = greatest.sum() / variances.all;
    return result;
}

Matrix shrunk(const Matrix& covariance, double shrinkage) {
    Matrix result = covariance;
    shrink(result, shrinkage);
    return result;
}

Matrix covariance_within(const Moments& moments) {
    Matrix result = moments.within();
    result /= static_cast<double>(moments.frames());
    return result;
}

std::optional<Matrix> metric(const Moments& moments, double shrinkage) {
    const auto cholesky = Cholesky::of(shrunk(covariance_within(moments), shrinkage));
    if (!cholesky) return std::nullopt;
    return cholesky->inverse();
}

std::optional<Affine> discriminant(const Moments& moments, double shrinkage) {
    Matrix room;
    return discriminant(moments, covariance_within(moments), shrinkage, room);
}

std::vector<Trial> trials(const Moments& training, const std::vector<const Moments*>& tests) {
    std::vector<Trial> result(tests.size());
    if (!has_both(training)) return result;
    const Matrix within = covariance_within(training);
    Matrix room;
    for (std::size_t i = 0; i < kShrinkages.size(); ++i) {
        const auto direction = discriminant(training, within, kShrinkages[i], room);
        if (!direction) continue;
        for (std::size_t t = 0; t < tests.size(); ++t)
            if (has_both(*tests[t])) result[t][i] = separation(*tests[t], direction->a.transpose());
    }
    return result;
}

std::optional<double> best_shrinkage(const std::vector<Trial>& trials) {
    std::array<double, kShrinkages.size()> sums{};
    std::array<std::size_t, kShrinkages.size()> counts{};
    for (const Trial& trial : trials)
        for (std::size_t i = 0; i < trial.size(); ++i) {
            if (!trial[i]) continue;
            sums[i] += *trial[i];
            ++counts[i];
        }
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < kShrinkages.size(); ++i)
        if (counts[i] >= 2 && (!best || counts[i] > counts[*best] ||
                               (counts[i] == counts[*best] && sums[i] > sums[*best])))
            best = i;
    if (!best) return std::nullopt;
    return kShrinkages[*best];
}

std::optional<Affine> logpzo(const Moments& moments) {
    const Matrix s = covariance(moments);
    const Matrix identity = Matrix::Identity(s.rows(), s.cols());
    const auto cholesky = Cholesky::of(identity + s);
    if (!cholesky) return std::nullopt;
    // 2.5 I - 0.5 S = 3 I - 0.5 (I + S)
    return Affine{3 * cholesky->inverse() - 0.5 * identity, moments.mean(kHolds)};
}

}  // namespace etlc::fit
