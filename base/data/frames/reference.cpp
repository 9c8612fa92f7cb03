#include "data/frames/reference.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace etlc::data {

namespace {

constexpr std::uint32_t kHeight = 480;
constexpr std::uint32_t kWidth = 640;

/// Mixes 32 bits; a bijection, "lowbias32" of github.com/skeeto/hash-prospector.
constexpr std::uint32_t mixed(std::uint32_t bits) {
    bits ^= bits >> 16U;
    bits *= 0x7feb352dU;
    bits ^= bits >> 15U;
    bits *= 0x846ca68bU;
    return bits ^ bits >> 16U;
}

/// Random numbers from 0 to 255 at the corners of square cells, interpolated inside of them.
class Noise {
public:
    Noise(std::uint32_t seed, std::uint32_t cell) : cell_(cell), columns_(kWidth / cell + 2) {
        const std::uint32_t row_seed = mixed(seed);
        for (std::uint32_t row = 0; row < kHeight / cell + 2; ++row)
            for (std::uint32_t column = 0; column < columns_; ++column)
                corners_.push_back(mixed(column + mixed(row + row_seed)) >> 24U);
    }

    std::uint32_t at(std::uint32_t y, std::uint32_t x) const {
        const std::uint32_t down = y % cell_;
        const std::uint32_t right = x % cell_;
        const std::uint32_t* above = &corners_[y / cell_ * columns_ + x / cell_];
        const std::uint32_t* below = above + columns_;
        const std::uint32_t top = above[0] * (cell_ - right) + above[1] * right;
        const std::uint32_t bottom = below[0] * (cell_ - right) + below[1] * right;
        return (top * (cell_ - down) + bottom * down) / (cell_ * cell_);
    }

private:
    std::uint32_t cell_;
    std::uint32_t columns_;
    std::vector<std::uint32_t> corners_;
};

class ReferenceFrames final : public FrameSource {
public:
    diag::Result<bool> next(Frame& frame) override {
        if (index_ == kReferenceFrames) return false;
        frame = reference_frame(index_++);
        return true;
    }

private:
    std::uint32_t index_ = 0;
};

}  // namespace

Frame reference_frame(std::uint32_t index) {
    constexpr std::uint32_t kColours = 3;
    Frame frame{kHeight, kWidth, std::string(std::size_t{kHeight} * kWidth * kColours, '\0')};
    for (std::uint32_t colour = 0; colour < kColours; ++colour) {
        const std::uint32_t seed = 16 * index + 4 * colour;
        const std::uint32_t mean = 32 + (index + colour) % kColours * 96;
        const Noise coarse(seed + 3, 64), middle(seed + 2, 16), fine(seed + 1, 4), dots(seed, 1);
        for (std::uint32_t y = 0; y < kHeight; ++y)
            for (std::uint32_t x = 0; x < kWidth; ++x)
                frame.rgb[(y * kWidth + x) * kColours + colour] =
                    static_cast<char>((2 * coarse.at(y, x) + 2 * middle.at(y, x) + fine.at(y, x) +
                                       dots.at(y, x) + 2 * mean) /
                                      8);
    }
    return frame;
}

std::unique_ptr<FrameSource> reference_frames() {
    return std::make_unique<ReferenceFrames>();
}

double relative_difference(const float* z, const float* r, std::size_t elements) {
    double difference = 0, length = 0;
    for (std::size_t i = 0; i < elements; ++i) {
        difference += (double{z[i]} - r[i]) * (double{z[i]} - r[i]);
        length += double{r[i]} * r[i];
    }
    const double relative = std::sqrt(difference / (length > 0 ? length : 1));
    return std::isfinite(relative) ? relative : std::numeric_limits<double>::infinity();
}

}  // namespace etlc::data
