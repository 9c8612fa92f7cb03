// The samples of a point at earlier steps, as etlmon/past/points.hpp keeps them; in float32, which
// has every float16 and every scaled int8 that an input can have.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::plan {

class EarlierSamples {
public:
    EarlierSamples(check::Index point, std::uint32_t steps, std::uint32_t dimension)
        : point_(point),
          dimension_(dimension),
          samples_(std::size_t{steps} * dimension),
          present_(steps) {}

    check::Index point() const { return point_; }
    void reset() {
        next_ = 0;
        present_.assign(present_.size(), false);
    }
    /// Returns the sample of `ago` steps before the one that is pushed next; null if there is none.
    const float* at(std::uint32_t ago) const {
        const std::size_t slot = (next_ + present_.size() - ago) % present_.size();
        return present_[slot] ? samples_.data() + slot * dimension_ : nullptr;
    }
    /// Adds the sample of this step; null if it is missing.
    void push(const float* sample) {
        if (sample != nullptr)
            std::copy_n(sample, dimension_,
                        samples_.begin() + static_cast<std::ptrdiff_t>(next_ * dimension_));
        present_[next_] = sample != nullptr;
        next_ = (next_ + 1) % present_.size();
    }

    /// Passes its numbers to an archive (archive.hpp).
    template <class Self, class Archive>
    static void visit(Self& self, Archive& archive) {
        archive.number(self.next_);
        archive.fixed(self.samples_);
        archive.bools(self.present_);
    }
    bool fits() const { return next_ < present_.size(); }

private:
    check::Index point_;
    std::uint32_t dimension_;
    std::size_t next_ = 0;
    std::vector<float> samples_;
    std::vector<bool> present_;
};

}  // namespace etlc::plan
