#include "parse/stream/byte_stream.hpp"

#include <algorithm>

namespace etlc::parse {

void ByteStream::consume() {
    if (at_ < text_.size()) ++at_;
}

std::size_t ByteStream::LA(ssize_t i) {
    if (i == 0) return 0;
    const ssize_t at = static_cast<ssize_t>(at_) + (i > 0 ? i - 1 : i);
    if (at < 0 || at >= static_cast<ssize_t>(text_.size())) return EOF;
    constexpr unsigned char kDel = 0x7F;
    return std::min(static_cast<unsigned char>(text_[static_cast<std::size_t>(at)]), kDel);
}

void ByteStream::seek(std::size_t index) {
    at_ = std::min(index, text_.size());
}

std::string ByteStream::getText(const antlr4::misc::Interval& interval) {
    const auto begin = static_cast<std::size_t>(std::max<ssize_t>(interval.a, 0));
    const auto end =
        std::min(static_cast<std::size_t>(std::max<ssize_t>(interval.b + 1, 0)), text_.size());
    return begin < end ? std::string(text_.substr(begin, end - begin)) : std::string();
}

}  // namespace etlc::parse
