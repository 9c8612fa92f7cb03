#include "lsp/protocol/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "data/text/text.hpp"

namespace etlc::lsp {

namespace {

/// Longer than any header; the end of a longer line is kept, since a header may begin there.
constexpr std::size_t kLongestLine = 4096;
constexpr std::string_view kLength = "content-length";
constexpr std::string_view kType = "content-type";

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

void Reader::add(std::string_view bytes) {
    forget_consumed();
    bytes_ += bytes;
}

void Reader::forget_consumed() {
    bytes_.erase(0, at_);
    searched_ -= std::min(searched_, at_);
    at_ = 0;
}

std::optional<Frame> Reader::next() {
    while (true) {
        if (in_content_) return content();
        auto header = line();
        if (!header) return std::nullopt;
        if (!header->empty()) {
            take_header(std::move(*header));
        } else if (auto broken = end_of_headers()) {
            return broken;
        }
    }
}

std::optional<std::string> Reader::line() {
    searched_ = std::max(searched_, at_);
    const std::size_t end = bytes_.find('\n', searched_);
    if (end == std::string::npos) {
        searched_ = bytes_.size();
        if (bytes_.size() - at_ > kLongestLine) {
            mistake_ = "a header is too long";
            at_ = bytes_.size() - kLongestLine / 2;
            forget_consumed();
        }
        return std::nullopt;
    }
    std::string result = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    searched_ = at_;
    if (result.ends_with('\r')) result.pop_back();
    return result;
}

void Reader::take_header(std::string header) {
    has_headers_ = true;
    // After a broken frame the next header may share a line with the rest of it.
    const std::size_t begin = lower(header).rfind(std::string(kLength) + ":");
    if (begin != std::string::npos && begin > 0) {
        mistake_ = "expected a header, found something else";
        header.erase(0, begin);
    }
    const std::size_t colon = header.find(':');
    if (colon == std::string::npos) {
        mistake_ = "expected a header, found something else";
        return;
    }
    const std::string name = lower(trimmed(std::string_view(header).substr(0, colon)));
    const std::string_view value = trimmed(std::string_view(header).substr(colon + 1));
    if (name == kLength) {
        length_ = data::parse_whole<std::uint64_t>(value);
        if (!length_) mistake_ = "Content-Length is not a number of bytes";
    } else if (name == kType) {
        const std::string type = lower(value);
        const std::size_t charset = type.find("charset=");
        if (charset != std::string::npos && type.find("utf-8", charset) == std::string::npos &&
            type.find("utf8", charset) == std::string::npos)
            mistake_ = "the content is not UTF-8, as Content-Type says";
    }
}

std::optional<Frame> Reader::end_of_headers() {
    if (!has_headers_) return std::nullopt;  // an empty line between two messages
    has_headers_ = false;
    in_content_ = length_.has_value();
    skipped_ = 0;
    if (!in_content_ && mistake_.empty()) mistake_ = "there is no Content-Length";
    if (in_content_ && *length_ > kMostContent)
        mistake_ =
            fmt::format("a message of {} bytes; at most {} are read", *length_, kMostContent);
    if (mistake_.empty()) return std::nullopt;
    // Its content still follows, as a separate message.
    Frame broken{{}, std::move(mistake_)};
    mistake_.clear();
    return broken;
}

std::optional<Frame> Reader::content() {
    const std::size_t there = bytes_.size() - at_;
    if (*length_ > kMostContent) {
        const std::uint64_t taken = std::min<std::uint64_t>(there, *length_ - skipped_);
        at_ += static_cast<std::size_t>(taken);
        skipped_ += taken;
        forget_consumed();
        if (skipped_ < *length_) return std::nullopt;
        in_content_ = false;
        length_.reset();
        return next();
    }
    if (there < *length_) return std::nullopt;
    Frame frame{bytes_.substr(at_, static_cast<std::size_t>(*length_)), {}};
    at_ += static_cast<std::size_t>(*length_);
    in_content_ = false;
    length_.reset();
    return frame;
}

}  // namespace etlc::lsp
