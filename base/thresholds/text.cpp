#include "thresholds/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace etlc::thresholds {

namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16U;
constexpr std::size_t kBehind = 4;  ///< bytes of the piece before that stay in reach

bool continues(char c) {
    return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U;
}

/// Where one is behind `text`.
source::Position behind(source::Position place, std::string_view text) {
    place.line += static_cast<std::uint32_t>(std::count(text.begin(), text.end(), '\n'));
    const std::size_t feed = text.rfind('\n');
    if (feed != std::string_view::npos) {
        place.column = 1;
        text.remove_prefix(feed + 1);
    }
    const auto inside = std::count_if(text.begin(), text.end(), continues);
    place.column += static_cast<std::uint32_t>(static_cast<std::ptrdiff_t>(text.size()) - inside);
    return place;
}

}  // namespace

bool Text::next_piece() {
    const std::uint64_t counted = counted_ + read() - passed_;
    if (counted > most_ && !failure_)
        failure_ = diag::Failure{
            unreadable_,
            fmt::format("is larger than {} bytes without its recordings, the most that is read",
                        most_)};
    const std::size_t past = piece_.size() - std::min(piece_.size(), kBehind);
    begin_place_ = behind(begin_place_, std::string_view(piece_).substr(0, past));
    begin_ += past;
    piece_.erase(0, past);
    at_ = piece_.size();
    return extend();
}

bool Text::extend() {
    if (failure_) return false;
    const std::size_t before = piece_.size();
    piece_.resize(before + kPiece);
    const auto got = source_.read(piece_.data() + before, kPiece);
    piece_.resize(before + (got ? *got : 0));
    if (!got) {
        failure_ = got.failure();
        if (failure_->code == diag::Code::unreadable_data_file) failure_->code = unreadable_;
    }
    return piece_.size() > before;
}

source::Position Text::place(std::uint64_t at) const {
    return behind(begin_place_, std::string_view(piece_).substr(0, at - begin_));
}

std::string Text::character(std::uint64_t at) {
    const auto first = static_cast<std::size_t>(at - begin_);
    if (first + kBehind > piece_.size()) extend();
    if (first >= piece_.size()) return {};
    std::size_t end = first + 1;
    while (end < piece_.size() && end < first + 4 && continues(piece_[end])) ++end;
    return piece_.substr(first, end - first);
}

}  // namespace etlc::thresholds
