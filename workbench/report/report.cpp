#include "report/report.hpp"

#include <zlib.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <tuple>

#include "data/files/file.hpp"
#include "episodes/parallel.hpp"
#include "report/document.hpp"
#include "source/text.hpp"

namespace etlc::report {

namespace {

/// Bytes of a row without its series; rows take at most a quarter of the page.
constexpr std::uint64_t kBytesPerRow = 240;
constexpr std::uint64_t kLeastForSeries = 2048;
constexpr std::uint64_t kLeastForPictures = 20'000;

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

/// Packs an episode into a short text: base64 of deflated bytes. These are the length of a JSON
/// head in 4 bytes, the head, and the series in the order of their addition, each byte by byte of
/// all its numbers, which deflates better than number by number. Truths and verdicts are never
/// reduced to buckets.
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
        const std::string head =
            fmt::format("{{\"steps\":{},\"buckets\":{},\"tracks\":[{}],\"why\":[{}]}}",
                        tracks_.frames, buckets_, tracks, why);
        std::string bytes;
        for (std::size_t byte = 0; byte < 4; ++byte)
            bytes += static_cast<char>(head.size() >> (8 * byte) & 0xFFU);
        return base64(deflated(bytes + head + body_));
    }

private:
    // Each of these returns the JSON that describes the numbers in the head.

    /// Adds the exact float32.
    std::string exact(const std::vector<float>& numbers) {
        std::vector<std::uint32_t> words(numbers.size());
        std::memcpy(words.data(), numbers.data(), numbers.size() * sizeof(float));
        add_bytes(words, 4);
        return fmt::format("{{\"type\":\"exact\",\"count\":{}}}", numbers.size());
    }

    /// Adds numbers rounded to parts of the span (even, at most 32,000), as successive differences:
    /// they are off by at most half a part; infinite and missing numbers stay so.
    std::string rounded(const std::vector<float>& numbers) {
        const Span span = span_of(numbers);
        const double part = (static_cast<double>(span.high) - span.low) / parts_;
        std::vector<std::uint32_t> words;
        words.reserve(numbers.size());
        std::uint32_t before = 0;
        for (const float x : numbers) {
            std::int32_t value = std::isnan(x) ? kMissing : x < 0 ? kBelowAll : kAboveAll;
            if (std::isfinite(x))
                value = part == 0 ? 0
                                  : static_cast<std::int32_t>(std::lround((x - span.low) / part)) -
                                        parts_ / 2;
            words.push_back((static_cast<std::uint32_t>(value) - before) & 0xFFFFU);
            before = static_cast<std::uint32_t>(value);
        }
        add_bytes(words, 2);
        return fmt::format(
            "{{\"type\":\"rounded\",\"count\":{},\"parts\":{},\"low\":{},\"high\":{}}}",
            numbers.size(), parts_, span.low, span.high);
    }

    /// Adds whole numbers, in as many bytes as the greatest takes.
    std::string whole(const std::vector<std::uint32_t>& numbers) {
        const std::uint32_t greatest =
            numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end());
        const std::size_t bytes = greatest < 1U << 8U ? 1 : greatest < 1U << 16U ? 2 : 4;
        add_bytes(numbers, bytes);
        return fmt::format("{{\"type\":\"whole\",\"count\":{},\"bytes\":{}}}", numbers.size(),
                           bytes);
    }

    void add_bytes(const std::vector<std::uint32_t>& words, std::size_t bytes) {
        const std::size_t before = body_.size();
        body_.resize(before + bytes * words.size());
        char* to = body_.data() + before;
        for (std::size_t byte = 0; byte < bytes; ++byte)
            for (const std::uint32_t word : words)
                *to++ = static_cast<char>(word >> (8 * byte) & 0xFFU);
    }

    std::string number_part(const std::vector<float>& values) {
        return parts_ == 0 ? exact(values) : rounded(values);
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
        return whole(reduced ? firsts(series.values) : series.values);
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
    std::string body_;
};

/// Returns the first form of at most `most` bytes, or the smallest: exact, rounded, or reduced to
/// the least and greatest numbers of buckets of steps.
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

/// Orders episodes without truths: alarms first, then by the least robustness.
std::tuple<bool, float> badness(const Row& row) {
    bool alarm = false;
    float least = std::numeric_limits<float>::infinity();
    for (const Outcome& outcome : row.outcomes) {
        alarm |= outcome.alarm.has_value();
        least = std::min(least, outcome.robustness);
    }
    return {!alarm, least};
}

Row row_of(const Tracks& tracks) {
    Row row;
    row.path = tracks.path;
    row.frames = tracks.frames;
    row.outcomes = tracks.outcomes;
    for (const execute::SampleCounts& counts : tracks.sample_counts)
        row.missing += counts.missing + counts.out_of_range + counts.stale;
    return row;
}

/// The rows of the page, worst first, with the series and pictures that fit.
class Shelf {
public:
    /// `ranked` rows have a rank from the evaluation.
    Shelf(bool ranked, bool pictured, std::size_t episodes, std::uint64_t bytes)
        : ranked_(ranked),
          most_rows_(std::min<std::uint64_t>(episodes, bytes / 4 / kBytesPerRow)),
          room_((bytes - most_rows_ * kBytesPerRow) / (pictured ? 2 : 1)) {}

    /// Return the bytes available for the series, and for the pictures, of an episode.
    std::uint64_t share() const {
        return std::max(room_ / std::max<std::uint64_t>(1, most_rows_), kLeastForSeries);
    }
    std::uint64_t share_of_pictures() const {
        return std::clamp(room_ / std::max<std::uint64_t>(1, most_rows_), kLeastForPictures,
                          std::max(room_, kLeastForPictures));
    }

    void add(Row row) {
        series_ += row.blob.text.size();
        pictures_ += row.pictures.bytes();
        const auto at =
            std::upper_bound(rows_.begin(), rows_.end(), row,
                             [&](const Row& a, const Row& b) { return is_worse(a, b); });
        rows_.insert(at, std::move(row));
        if (rows_.size() > most_rows_) {
            take_from(rows_.back(), true, true);
            rows_.pop_back();
        }
        // The best episodes lose theirs first.
        for (std::size_t i = rows_.size(); (series_ > room_ || pictures_ > room_) && i-- > 0;)
            take_from(rows_[i], series_ > room_, pictures_ > room_);
    }

    std::vector<Row> take() { return std::move(rows_); }

private:
    bool is_worse(const Row& a, const Row& b) const {
        return ranked_ ? a.rank < b.rank : badness(a) < badness(b);
    }
    void take_from(Row& row, bool series, bool pictures) {
        if (series) series_ -= row.blob.text.size();
        if (pictures) pictures_ -= row.pictures.bytes();
        if (series) row.blob = {};
        if (pictures) row.pictures = {};
    }

    bool ranked_;
    std::uint64_t most_rows_;
    std::uint64_t room_;  ///< bytes for series, and as many again for pictures
    std::uint64_t series_ = 0;
    std::uint64_t pictures_ = 0;
    std::vector<Row> rows_;
};

std::vector<Index> shown_predicates(const Material& material) {
    std::vector<Index> shown = material.spec.plan.predicates;
    if (material.truth != nullptr)
        shown.insert(shown.end(), material.truth->labelled.begin(), material.truth->labelled.end());
    std::sort(shown.begin(), shown.end());
    shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
    return shown;
}

/// Reads and packs episodes, on one thread.
class Packer {
public:
    Packer(const Scene& scene, const Request& request, const Shelf& shelf)
        : reader_(scene), scene_(scene), request_(request), shelf_(shelf) {}

    struct Packed {
        Row row;
        std::vector<execute::SampleCounts> sample_counts;
        std::vector<std::int64_t> unknown;
    };
    diag::Result<Packed> score(const std::string& path) {
        const auto tracks = reader_.score(path);
        if (!tracks) return tracks.failure();
        Packed packed{row_of(*tracks), tracks->sample_counts, {}};
        const auto is_unknown = [](std::uint32_t code) { return code % kFinal == kUnknown; };
        for (const auto& [of, index, codes] : tracks->codes)
            if (of == "holds" || of == "status")
                packed.unknown.push_back(std::ranges::count_if(codes, is_unknown));
        packed.row.blob = blob_of(*tracks, shelf_.share());
        if (request_.frames.text.empty()) return packed;
        const double seconds = scene_.plan.model->step_seconds;
        auto pictures =
            pictures_of(request_.frames, path, {tracks->frames, seconds > 0 ? 1 / seconds : 0},
                        telling_steps(*tracks), shelf_.share_of_pictures());
        if (!pictures) return pictures.failure();
        packed.row.pictures = std::move(*pictures);
        return packed;
    }

private:
    TrackReader reader_;
    const Scene& scene_;
    const Request& request_;
    const Shelf& shelf_;
};

/// Collects the packed episodes, in order.
class Gathering {
public:
    Gathering(const plan::Plan& plan, const std::vector<evaluate::EpisodeRow>& judged, Shelf& shelf)
        : ranked_(!judged.empty()), shelf_(shelf) {
        totals.sample_counts.resize(plan.inputs.size());
        for (std::size_t i = 0; i < judged.size(); ++i) rank_.emplace(judged[i].path, i);
    }

    void add(Packer::Packed packed) {
        ++totals.episodes;
        totals.steps += packed.row.frames;
        totals.unknown.resize(packed.unknown.size());
        for (std::size_t i = 0; i < packed.unknown.size(); ++i)
            totals.unknown[i] += packed.unknown[i];
        for (std::size_t i = 0; i < totals.sample_counts.size(); ++i) {
            totals.sample_counts[i].missing += packed.sample_counts[i].missing;
            totals.sample_counts[i].out_of_range += packed.sample_counts[i].out_of_range;
            totals.sample_counts[i].stale += packed.sample_counts[i].stale;
            totals.sample_counts[i].held += packed.sample_counts[i].held;
        }
        if (ranked_) packed.row.rank = rank_.at(packed.row.path);
        if (!packed.row.pictures.why.empty() && unpictured++ == 0)
            first_unpictured = data::in_file({diag::Code::frames_left_out, packed.row.pictures.why},
                                             packed.row.path);
        shelf_.add(std::move(packed.row));
    }

    Totals totals;
    std::uint64_t unpictured = 0;  ///< episodes without pictures
    diag::Diagnostic first_unpictured{};

private:
    bool ranked_;
    Shelf& shelf_;
    std::map<std::string, std::size_t> rank_;
};

/// Reports episodes without pictures. Returns false if none has any.
bool report_unpictured(const Gathering& gathered, diag::Sink& sink) {
    if (gathered.unpictured == 0) return true;
    const bool none = gathered.unpictured == gathered.totals.episodes;
    diag::Diagnostic found = gathered.first_unpictured;
    if (none) found.code = diag::Code::no_frames;
    sink.report(std::move(found))
        .note(none ? "no episode has the pictures that --frames names"
                   : fmt::format("{} of {} without pictures", gathered.unpictured,
                                 diag::counted(gathered.totals.episodes, "episode")));
    return !none;
}

}  // namespace

bool Page::write(const std::function<bool(std::string_view)>& take) const {
    if (!take(head)) return false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string text = text_of(rows[i], judged.empty() ? nullptr : &judged[rows[i].rank]);
        if ((i > 0 && !take(",")) || !take(text)) return false;
    }
    return take(tail);
}

std::optional<Page> page(const Material& material, const Request& request, diag::Sink& sink) {
    if (!check_pattern(request.frames, request.episodes.size(), sink)) return std::nullopt;
    const plan::Plan& plan = material.spec.plan;
    std::optional<Compiled> truth;
    if (material.truth != nullptr) {
        truth =
            compile(material.truth->truth.model, {request.limits, check::Values::boolean}, sink);
        if (!truth) return std::nullopt;
    }
    Scene scene{plan,
                shown_predicates(material),
                material.truth,
                truth ? &truth->plan : nullptr,
                request.reading,
                {},
                {}};
    auto drawn = planes(*plan.model, scene.predicates, request.episodes, request.reading);
    if (!drawn) {
        sink.report(recordings::in_trace(drawn.failure(), request.episodes[0]));
        return std::nullopt;
    }
    scene.planes = std::move(*drawn);
    scene.target_pictures = pictures_of_targets(*plan.model, scene.predicates,
                                                request.megabytes * 1'000'000 / 10, sink);

    std::vector<evaluate::EpisodeRow> judged;
    std::string figures = "null";
    if (material.judgement != nullptr) {
        judged = evaluate::by_episode(*material.judgement);
        evaluate::SideBySide one;
        one.specs.push_back(
            {material.file.path(), evaluate::summarise(*material.judgement, request.jobs), {}});
        figures = in_script(evaluate::json(one));
    }
    const Totals none{0, 0, {}, std::vector<execute::SampleCounts>(plan.inputs.size())};
    const std::uint64_t bytes = request.megabytes * 1'000'000;
    const std::string shown = predicates(material, scene);
    Frame frame = frame_of(figures);
    frame.after.insert(0, kEnd);
    const std::uint64_t fixed =
        frame.before.size() + head(material, scene, shown, none).size() + frame.after.size();
    Shelf shelf(!judged.empty(), !request.frames.text.empty(), request.episodes.size(),
                bytes > 2 * fixed ? bytes - fixed : bytes / 2);
    Gathering gathered(plan, judged, shelf);
    const bool read = episodes::in_order<Packer::Packed>(
        request.episodes, request, sink,
        [&] { return std::make_unique<Packer>(scene, request, shelf); },
        [&](std::size_t, Packer::Packed packed) { gathered.add(std::move(packed)); });
    if (!read || !report_unpictured(gathered, sink)) return std::nullopt;
    return Page{frame.before + head(material, scene, shown, gathered.totals), shelf.take(),
                std::move(judged), std::move(frame.after)};
}

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
