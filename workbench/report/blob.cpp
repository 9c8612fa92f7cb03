#include "report/blob.hpp"

#include <zlib.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

#include "report/pictures.hpp"
#include "source/text.hpp"

namespace etlc::report {

namespace {

constexpr std::uint64_t kMostSteps = 2000;  ///< longer series are reduced to kBuckets of steps
constexpr std::uint64_t kBuckets = 1000;
/// An eighth of a pixel of a timeline, which is 64 pixels high.
constexpr int kFewestParts = 500;

// Codes of numbers that cannot be rounded, in two bytes.
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

/// Appends room for `more` bytes to the text; returns where it begins.
char* grown(std::string& text, std::size_t more) {
    const std::size_t before = text.size();
    text.resize(before + more);
    return text.data() + before;
}

/// Packs series of numbers into a short text: base64 of deflated bytes. These are the length of a
/// JSON head in 4 bytes, the head, and the series in the order of their addition, each byte by byte
/// of all its numbers, which deflates better than number by number. Rounded numbers are off by at
/// most half a part of the span; infinite and missing numbers stay so. Each function returns the
/// JSON that describes the series in the head.
class Packing {
public:
    /// Adds the exact float32.
    std::string exact(const std::vector<float>& numbers);
    /// Adds numbers rounded to `parts` of the span (even, at most 32,000), as successive
    /// differences.
    std::string rounded(const std::vector<float>& numbers, int parts);
    /// Adds whole numbers, in as many bytes as the greatest takes.
    std::string whole(const std::vector<std::uint32_t>& numbers);

    std::string packed(std::string_view head) const;

private:
    void add_bytes(const std::vector<std::uint32_t>& words, std::size_t bytes);

    std::string body_;
};

void Packing::add_bytes(const std::vector<std::uint32_t>& words, std::size_t bytes) {
    char* to = grown(body_, bytes * words.size());
    for (std::size_t byte = 0; byte < bytes; ++byte)
        for (const std::uint32_t word : words)
            *to++ = static_cast<char>(word >> (8 * byte) & 0xFFU);
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
    words.reserve(numbers.size());
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

class Writer {
public:
    /// `parts` is 0 for exact numbers.
    Writer(const Tracks& tracks, int parts, std::uint64_t buckets)
        : tracks_(tracks), parts_(parts), buckets_(buckets) {}

    std::string text() {
        std::string tracks;
        const auto add = [&](const auto& series, const std::string& parts) {
            tracks += fmt::format("{}{{\"of\":\"{}\",\"index\":{},\"parts\":[{}]}}",
                                  tracks.empty() ? "" : ",", series.of, series.index, parts);
        };
        for (const Numbers& series : tracks_.numbers) add(series, parts_of(series));
        for (const Codes& series : tracks_.codes) add(series, parts_of(series));
        std::string why;
        for (const Why& reason : tracks_.reasons) why += (why.empty() ? "" : ",") + text_of(reason);
        return packing_.packed(
            fmt::format("{{\"steps\":{},\"buckets\":{},\"tracks\":[{}],"
                        "\"why\":[{}]}}",
                        tracks_.frames, buckets_, tracks, why));
    }

private:
    std::string number_part(const std::vector<float>& values) {
        const std::string part =
            parts_ == 0 ? packing_.exact(values) : packing_.rounded(values, parts_);
        return "{" + part + "}";
    }

    /// Returns the first step of a bucket, or the number of steps after the last bucket.
    std::size_t begin_of(std::uint64_t bucket) const {
        return static_cast<std::size_t>(bucket * tracks_.frames / buckets_);
    }

    template <class Value>
    std::vector<Value> firsts(const std::vector<Value>& values) const {
        std::vector<Value> result;
        for (std::uint64_t b = 0; b < buckets_; ++b) result.push_back(values[begin_of(b)]);
        return result;
    }

    std::string parts_of(const Numbers& series) {
        if (buckets_ == 0) return number_part(series.values);
        if (series.of == "x" || series.of == "y") return number_part(firsts(series.values));
        std::vector<float> low;
        std::vector<float> high;
        for (std::uint64_t b = 0; b < buckets_; ++b) {
            float least = std::numeric_limits<float>::quiet_NaN();
            float greatest = least;
            for (std::size_t i = begin_of(b); i < begin_of(b + 1); ++i) {
                least = std::fmin(least, series.values[i]);
                greatest = std::fmax(greatest, series.values[i]);
            }
            low.push_back(least);
            high.push_back(greatest);
        }
        const std::string first = number_part(low);
        return first + "," + number_part(high);
    }

    std::string parts_of(const Codes& series) {
        const bool reduced = buckets_ > 0 && series.of == "nearest";
        return "{" + packing_.whole(reduced ? firsts(series.values) : series.values) + "}";
    }

    static std::string text_of(const Mark& mark) {
        return fmt::format("{{\"{}\":{},\"first\":{},\"last\":{},\"holds\":{}}}",
                           mark.is_predicate ? "predicate" : "input", mark.index, mark.first,
                           mark.last, mark.holds);
    }

    static std::string text_of(const Why& why) {
        std::string samples;
        for (const Mark& mark : why.samples)
            samples += (samples.empty() ? "" : ",") + text_of(mark);
        return fmt::format(
            "{{\"monitor\":{},\"step\":{},\"position\":{},\"status\":\"{}\",\"for_good\":{},"
            "\"text\":{},\"samples\":[{}],\"critical\":{}}}",
            why.monitor, why.step, why.position, why.status, why.for_good,
            source::json_string(why.text), samples, why.critical ? text_of(*why.critical) : "null");
    }

    const Tracks& tracks_;
    int parts_;
    std::uint64_t buckets_;
    Packing packing_;
};

}  // namespace

std::string deflated(std::string_view bytes) {
    uLongf size = compressBound(bytes.size());
    std::string out(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(),
                  Z_DEFAULT_COMPRESSION) != Z_OK)
        throw std::bad_alloc();  // the only way in which it can fail here
    out.resize(size);
    return out;
}

Blob blob_of(const Tracks& tracks, std::uint64_t most) {
    const bool is_long = tracks.frames > kMostSteps;
    Blob blob;
    const std::uint64_t usual = is_long ? kBuckets : 0;
    for (const auto& [parts, buckets] :
         {std::pair(0, usual), std::pair(4000, usual), std::pair(kFewestParts, usual),
          std::pair(kFewestParts, std::uint64_t{200})}) {
        if (2 * buckets >= tracks.frames) continue;  // two numbers a bucket
        blob = {Writer(tracks, parts, buckets).text(), parts, buckets};
        if (blob.text.size() <= most) break;
    }
    return blob;
}

// Loops over the bytes of pictures, which a live page runs for each frame of a camera.

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text((bytes.size() + 2) / 3 * 4, '=');
    char* to = text.data();
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8U | (k < here ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k <= here; ++k) to[k] = kDigits[bits >> (18 - 6 * k) & 63U];
        to += 4;
    }
    return text;
}

Picture shrunk(std::string_view pixels, std::uint32_t width, std::uint32_t height,
               std::uint32_t channels, std::uint32_t most) {
    const std::uint32_t factor = (std::max(width, height) + most - 1) / most;
    const std::size_t rows = std::min(factor, height);
    const std::size_t columns = std::min(factor, width);
    const std::size_t green = channels == 1 ? 0 : 1;
    Picture result{std::max(width / factor, 1U), std::max(height / factor, 1U), ""};
    result.pixels.resize(std::size_t{3} * result.width * result.height);
    char* to = result.pixels.data();
    for (std::size_t y = 0; y < result.height; ++y)
        for (std::size_t x = 0; x < result.width; ++x) {
            std::array<std::uint32_t, 3> sums{};
            for (std::size_t v = y * factor; v < y * factor + rows; ++v) {
                const char* from = &pixels[(v * width + x * factor) * channels];
                for (std::size_t u = 0; u < columns; ++u, from += channels)
                    for (std::size_t c = 0; c < 3; ++c)
                        sums[c] += static_cast<std::uint8_t>(from[c * green]);
            }
            for (const std::uint32_t sum : sums) *to++ = static_cast<char>(sum / (rows * columns));
        }
    return result;
}

}  // namespace etlc::report
