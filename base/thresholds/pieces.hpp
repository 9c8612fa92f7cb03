// Text that is written a piece at a time.
// Takes: text. Gives: it on, in pieces of some size. Keeps true: memory is that of a piece.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace etlc::thresholds {

class Pieces {
public:
    /// Whether it took the text.
    using Take = std::function<bool(std::string_view)>;

    explicit Pieces(Take take) : take_(std::move(take)) {}

    void add(std::string_view text) {
        piece_ += text;
        if (piece_.size() >= kPiece) pass_on();
    }
    /// Whether all was taken.
    bool finish() {
        pass_on();
        return taken_;
    }

private:
    static constexpr std::size_t kPiece = std::size_t{1} << 16U;

    void pass_on() {
        taken_ = taken_ && take_(piece_);
        piece_.clear();
    }

    Take take_;
    std::string piece_;
    bool taken_ = true;
};

}  // namespace etlc::thresholds
