#include "report/blob.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "report/packing/pack.hpp"
#include "source/escape.hpp"

namespace etlc::report {

namespace {

constexpr std::uint64_t kMostSteps = 2000;  ///< longer series are reduced to kBuckets of steps
constexpr std::uint64_t kBuckets = 1000;
/// An eighth of a pixel of a timeline, which is 64 pixels high.
constexpr int kFewestParts = 500;

class Writer {
public:
    /// `parts`: 0 for numbers that are exact.
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

    /// The first step of a bucket; of the one behind the last, the number of steps.
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

}  // namespace etlc::report
