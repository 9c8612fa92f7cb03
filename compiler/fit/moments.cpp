#include "fit/moments.hpp"

namespace etlc::fit {

Moments::Moments(Eigen::Index dimension, bool with_scatter) {
    for (Class& one : classes_) one.mean = Vector::Zero(dimension);
    if (with_scatter) scatter_ = Matrix::Zero(dimension, dimension);
}

void Moments::add(std::size_t of_class, Eigen::Ref<Matrix> frames) {
    if (frames.cols() == 0) return;
    const Vector mean = frames.rowwise().mean();
    if (scatter_.size() > 0) {
        frames.colwise() -= mean;
        scatter_.selfadjointView<Eigen::Lower>().rankUpdate(frames);
    }
    move_mean(of_class, static_cast<std::uint64_t>(frames.cols()), mean);
}

void Moments::merge(const Moments& other) {
    if (scatter_.size() > 0) scatter_ += other.scatter_;
    for (std::size_t c = 0; c < kClasses; ++c)
        move_mean(c, other.classes_[c].n, other.classes_[c].mean);
}

void Moments::move_mean(std::size_t of_class, std::uint64_t n, const Vector& mean) {
    if (n == 0) return;
    Class& own = classes_[of_class];
    const Vector step = mean - own.mean;
    const auto there = static_cast<double>(own.n);
    const auto more = static_cast<double>(n);
    own.n += n;
    own.mean += more / (there + more) * step;
    if (scatter_.size() > 0 && there > 0)
        scatter_.selfadjointView<Eigen::Lower>().rankUpdate(step, there * more / (there + more));
}

Matrix Moments::scatter() const {
    return scatter_.selfadjointView<Eigen::Lower>();
}

Moments Moments::mapped(const Affine& map) const {
    Moments result(map.a.rows(), false);
    for (std::size_t c = 0; c < kClasses; ++c)
        result.classes_[c] = {classes_[c].n, map.a * (classes_[c].mean - map.offset)};
    if (scatter_.size() > 0)
        result.scatter_ = map.a * scatter_.selfadjointView<Eigen::Lower>() * map.a.transpose();
    return result;
}

}  // namespace etlc::fit
