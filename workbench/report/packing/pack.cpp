#include "report/packing/pack.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

namespace etlc::report {

namespace {

// What rounded numbers cannot be, in two bytes.
constexpr std::int32_t kMissing = -32768;
constexpr std::int32_t kBelowAll = -32767;
constexpr std::int32_t kAboveAll = 32767;

struct Span {
    float low = std::numeric_limits<float>::infinity();
    float high = -std::numeric_limits<float>::infinity();
};

Span span_of(const std::vector<float>& numbers) {
    Span span;
    for (const float x : numbers) {
        if (!std::isfinite(x)) continue;
        span.low = std::min(span.low, x);
        span.high = std::max(span.high, x);
    }
    return span.low <= span.high ? span : Span{0, 0};
}

}  // namespace

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8U | (k < here ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= here ? kDigits[bits >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

std::string deflated(std::string_view bytes) {
    uLongf size = compressBound(bytes.size());
    std::string out(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(),
                  Z_BEST_COMPRESSION) != Z_OK)
        throw std::bad_alloc();  // the only way in which it can fail here
    out.resize(size);
    return out;
}

void Packing::add_bytes(const std::vector<std::uint32_t>& words, std::size_t bytes) {
    for (std::size_t byte = 0; byte < bytes; ++byte)
        for (const std::uint32_t word : words)
            body_ += static_cast<char>(word >> (8 * byte) & 0xFFU);
}

std::string Packing::exact(const std::vector<float>& numbers) {
    std::vector<std::uint32_t> words(numbers.size());
    std::memcpy(words.data(), numbers.data(), numbers.size() * sizeof(float));
    add_bytes(words, 4);
    return fmt::format("\"type\":\"exact\",\"count\":{}", numbers.size());
}

std::string Packing::rounded(const std::vector<float>& numbers, int parts) {
    const Span span = span_of(numbers);
    const double part = (static_cast<double>(span.high) - span.low) / parts;
    std::vector<std::uint32_t> words;
    std::uint32_t before = 0;
    for (const float x : numbers) {
        std::int32_t value = std::isnan(x) ? kMissing : x < 0 ? kBelowAll : kAboveAll;
        if (std::isfinite(x))
            value = part == 0
                        ? 0
                        : static_cast<std::int32_t>(std::lround((x - span.low) / part)) - parts / 2;
        words.push_back((static_cast<std::uint32_t>(value) - before) & 0xFFFFU);
        before = static_cast<std::uint32_t>(value);
    }
    add_bytes(words, 2);
    return fmt::format("\"type\":\"rounded\",\"count\":{},\"parts\":{},\"low\":{},\"high\":{}",
                       numbers.size(), parts, span.low, span.high);
}

std::string Packing::whole(const std::vector<std::uint32_t>& numbers) {
    const std::uint32_t greatest =
        numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end());
    const std::size_t bytes = greatest < 1U << 8U ? 1 : greatest < 1U << 16U ? 2 : 4;
    add_bytes(numbers, bytes);
    return fmt::format("\"type\":\"whole\",\"count\":{},\"bytes\":{}", numbers.size(), bytes);
}

std::string Packing::packed(std::string_view head) const {
    std::string bytes;
    for (std::size_t byte = 0; byte < 4; ++byte)
        bytes += static_cast<char>(head.size() >> (8 * byte) & 0xFFU);
    bytes += head;
    bytes += body_;
    return base64(deflated(bytes));
}

}  // namespace etlc::report
