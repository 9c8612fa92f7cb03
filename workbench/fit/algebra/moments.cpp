#include "fit/algebra/moments.hpp"

#include <algorithm>
#include <map>

#include "fit/algebra/dense.hpp"

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

}  // namespace etlc::fit
