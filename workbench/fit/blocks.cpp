#include "fit/blocks.hpp"

#include <algorithm>
#include <atomic>
#include <map>

namespace etlc::fit {

Blocks::Blocks(Eigen::Index dimension, std::vector<bool> with_scatter)
    : frames_(dimension, kFrames),
      with_scatter_(std::move(with_scatter)),
      classes_(with_scatter_.size()),
      moments_(with_scatter_.size(), Moments(dimension)) {}

void Blocks::add(const std::vector<float>& point, const std::vector<std::int8_t>& classes) {
    frames_.col(filled_++) = Eigen::Map<const Eigen::VectorXf>(point.data(), frames_.rows());
    for (std::size_t i = 0; i < classes.size(); ++i) classes_[i].push_back(classes[i]);
    if (filled_ == kFrames) flush();
}

std::vector<Moments> Blocks::take() {
    flush();
    std::vector<Moments> result(moments_.size(), Moments(frames_.rows()));
    std::swap(result, moments_);
    return result;
}

void Blocks::flush() {
    std::map<std::vector<bool>, std::shared_ptr<Scatter>> scatters;  // by the frames in them
    std::vector<Moments> block;
    for (std::size_t i = 0; i < classes_.size(); ++i) {
        std::shared_ptr<Scatter> shared;
        if (with_scatter_[i]) {
            std::vector<bool> selected;
            for (const std::int8_t c : classes_[i]) selected.push_back(c != kNone);
            std::shared_ptr<Scatter>& found = scatters[selected];
            if (found == nullptr) found = scatter(selected);
            shared = found;
        }
        block.emplace_back(Moments::Means{mean(i, 0), mean(i, 1)}, std::move(shared));
    }
    scatters.clear();  // drops the other references
    std::vector<Moments*> all;
    std::vector<const Moments*> more;
    for (std::size_t i = 0; i < block.size(); ++i) {
        all.push_back(&moments_[i]);
        more.push_back(&block[i]);
        classes_[i].clear();
    }
    Moments::merge(all, more);
    filled_ = 0;
}

std::shared_ptr<Scatter> Blocks::scatter(const std::vector<bool>& selected) {
    selected_.resize(frames_.rows(), kFrames);
    Eigen::Index to = 0;
    for (std::size_t f = 0; f < selected.size(); ++f)
        if (selected[f])
            selected_.col(to++) = frames_.col(static_cast<Eigen::Index>(f)).cast<double>();
    std::shared_ptr<Scatter> result = unused_scatter();
    result->set(selected_.leftCols(to));
    return result;
}

std::shared_ptr<Scatter> Blocks::unused_scatter() {
    for (const std::shared_ptr<Scatter>& one : scatters_) {
        if (one.use_count() > 1) continue;
        std::atomic_thread_fence(std::memory_order_acquire);  // another thread may have held it
        return one;
    }
    scatters_.push_back(std::make_shared<Scatter>());
    return scatters_.back();
}

Mean Blocks::mean(std::size_t need, std::size_t of_class) const {
    Mean result = Mean::none(frames_.rows());
    for (std::size_t f = 0; f < classes_[need].size(); ++f) {
        if (classes_[need][f] != static_cast<std::int8_t>(of_class)) continue;
        result.mean += frames_.col(static_cast<Eigen::Index>(f)).cast<double>();
        ++result.n;
    }
    if (result.n > 0) result.mean /= static_cast<double>(result.n);
    return result;
}

}  // namespace etlc::fit
