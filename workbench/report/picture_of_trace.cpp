// Draws the timelines of one trace as an SVG picture, for papers and slides (`etlc run --svg`): a
// lane for each predicate and monitor, with its chart and the strips of its claims and truths, as
// the page shows them. The size does not depend on the number of steps: with more steps than
// pixels, a line goes through the least and the greatest number of each pixel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "data/files/file.hpp"
#include "report/report.hpp"
#include "report/tracks.hpp"
#include "source/text.hpp"

namespace etlc::report {

namespace {

// Lengths in pixels.
constexpr double kWidth = 900;
constexpr double kLeft = 70;
constexpr double kRight = 14;
constexpr double kInner = kWidth - kLeft - kRight;
constexpr double kTitle = 18;
constexpr double kChart = 66;
constexpr double kStrip = 7;
constexpr double kGap = 14;

// The colours of report/page/page.css.
constexpr const char* kStyle =
    "text{font:11px sans-serif;fill:#5d6b7c}.name{font-weight:600;font-size:12px;fill:#1b2330}"
    ".line{fill:none;stroke:#0b4f7c;stroke-width:1.4}.bounds{fill:#0072b2;fill-opacity:.11}"
    ".threshold{stroke:#b34700;stroke-width:1.3;stroke-dasharray:5 3}"
    ".axis{stroke:#d7dee6}.band{fill:#0072b2;fill-opacity:.13}"
    ".yes{fill:#0072b2}.no{fill:#e4e9ee}.open{fill:#a7b0ba}.violated{fill:#d55e00}"
    ".so-far{fill-opacity:.4}.true{fill:#3d4753}"
    ".mark{fill:#cc79a7;fill-opacity:.3}.critical{fill:none;stroke:#a8447d;stroke-width:2.5}";

struct Lane {
    std::string name;
    std::string text;
    const Numbers* numbers = nullptr;
    const Numbers* lower = nullptr;
    const Numbers* upper = nullptr;
    const Codes* said = nullptr;
    const Codes* truth = nullptr;
    float level = 0;
    bool of_monitor = false;
    std::size_t index = 0;
};

template <class Series>
const Series* find(const std::vector<Series>& all, const std::string& of, std::size_t index) {
    for (const Series& series : all)
        if (series.of == of && series.index == index) return &series;
    return nullptr;
}

std::vector<Lane> lanes_of(const Scene& scene, const Tracks& tracks) {
    const check::Model& model = *scene.plan.model;
    std::vector<Lane> lanes;
    for (std::size_t i = 0; i < scene.predicates.size(); ++i) {
        const check::Predicate& predicate = model.predicates[scene.predicates[i]];
        lanes.push_back(
            {predicate.shown(), fmt::format("{}{}", predicate.text, predicate.threshold.value),
             find(tracks.numbers, "distance", i), nullptr, nullptr, find(tracks.codes, "holds", i),
             find(tracks.codes, "truth", i), predicate.threshold.value, false, i});
    }
    for (std::size_t m = 0; m < scene.plan.monitors.size(); ++m) {
        const plan::Monitor& monitor = scene.plan.monitors[m];
        const Numbers* const robustness = find(tracks.numbers, "robustness", m);
        const auto bound = [&](const char* of) {
            const Numbers* const found = find(tracks.numbers, of, m);
            return monitor.sliding ? nullptr : found != nullptr ? found : robustness;
        };
        lanes.push_back({monitor.name, check::shown(model, model.monitors[monitor.index].formula),
                         robustness, bound("lower"), bound("upper"),
                         find(tracks.codes, "status", m), find(tracks.codes, "monitor_truth", m), 0,
                         true, m});
    }
    return lanes;
}

/// Escapes text for XML. source::visible leaves no other characters that XML forbids.
std::string xml(const std::string& text) {
    std::string result;
    for (const char c : source::visible(text)) switch (c) {
            case '<': result += "&lt;"; break;
            case '>': result += "&gt;"; break;
            case '&': result += "&amp;"; break;
            case '"': result += "&quot;"; break;
            default: result += c;
        }
    return result;
}

class Drawing {
public:
    Drawing(const Scene& scene, const Tracks& tracks) : scene_(scene), tracks_(tracks) {
        why_ = nullptr;
        for (const Why& why : tracks.reasons)
            if (why_ == nullptr ||
                (tracks.outcomes[why.monitor].alarm && !tracks.outcomes[why_->monitor].alarm))
                why_ = &why;
    }

    std::string text() {
        for (const Lane& lane : lanes_of(scene_, tracks_)) draw(lane);
        draw_time();
        const double height = top_ + 36;
        return fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" "
            "viewBox=\"0 0 {0:g} {1:g}\">\n<style>{2}</style>\n"
            "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#ffffff\"/>\n"
            "<g transform=\"translate({3:g},0)\">\n{4}</g>\n</svg>\n",
            kWidth, height, kStyle, kLeft, body_);
    }

private:
    double x(double step) const {
        const double last = std::max<double>(static_cast<double>(tracks_.frames) - 1, 1);
        return std::clamp(step / last, 0.0, 1.0) * kInner;
    }

    void rectangle(const std::string& kind, double from, double to, double y, double height) {
        body_ += fmt::format(
            "<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:g}\"/>\n",
            kind, from, y, std::max(to - from, 0.8), height);
    }

    void words(double at, double y, const std::string& text, const char* anchor = "start",
               const char* kind = "") {
        body_ += fmt::format(
            "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" class=\"{}\">{}</text>\n", at, y,
            anchor, kind, xml(text));
    }

    struct Scale {
        double low;
        double high;
        double top;
        double operator()(double value) const {
            return top + kChart * (1 - std::clamp((value - low) / (high - low), 0.0, 1.0));
        }
    };

    Scale scale_of(const Lane& lane) const {
        double low = lane.level;
        double high = lane.level;
        for (const float value : lane.numbers->values) {
            if (!std::isfinite(value)) continue;
            low = std::min<double>(low, value);
            high = std::max<double>(high, value);
        }
        const double room = high > low ? (high - low) * 0.06 : 0.5;
        return {low - room, high + room, top_ + kTitle};
    }

    void draw(const Lane& lane) {
        words(0, top_ + 13, lane.name, "start", "name");
        words(8 + 7.5 * static_cast<double>(lane.name.size()), top_ + 13, lane.text);
        const Scale y = scale_of(lane);
        for (const double value : {y.low + (y.high - y.low) * 0.1, y.high - (y.high - y.low) * 0.1})
            words(-6, y(value) + 4, fmt::format("{:.3g}", value), "end");
        if (!lane.of_monitor)
            draw_runs(*lane.said, [&](std::uint32_t code, double from, double to) {
                if (code == kYes) rectangle("band", from, to, y.top, kChart);
            });
        if (lane.lower != nullptr) draw_bounds(lane, y);
        if (!lane.of_monitor) draw_marks(lane, y);
        body_ += fmt::format(
            "<line class=\"axis\" y1=\"{0:g}\" y2=\"{1:g}\"/>\n<line "
            "class=\"threshold\" x2=\"{2:g}\" y1=\"{3:.1f}\" y2=\"{3:.1f}\"/>\n",
            y.top, y.top + kChart, kInner, y(lane.level));
        body_ += fmt::format("<path class=\"line\" d=\"{}\"/>\n", line(lane.numbers->values, y));
        top_ += kTitle + kChart + 2;
        strip(*lane.said, "said", lane.of_monitor ? "violated" : "no");
        if (lane.truth != nullptr) strip(*lane.truth, "true", "no");
        top_ += kGap;
    }

    template <class Draw>
    void draw_runs(const Codes& codes, const Draw& draw) {
        const auto& all = codes.values;
        for (std::size_t first = 0; first < all.size();) {
            std::size_t end = first;
            while (end < all.size() && all[end] == all[first]) ++end;
            draw(all[first], x(static_cast<double>(first) - 0.5),
                 x(static_cast<double>(end) - 0.5));
            first = end;
        }
    }

    void strip(const Codes& codes, const char* label, const char* no) {
        words(-6, top_ + kStrip, label, "end");
        draw_runs(codes, [&](std::uint32_t code, double from, double to) {
            const std::uint32_t status = code % kFinal;
            const std::string yes = std::string(label) == "true" ? "true" : "yes";
            std::string kind = status == kYes ? yes : status == kNo ? no : "open";
            if (codes.of == "status" && code < kFinal) kind += " so-far";
            rectangle(kind, from, to, top_, kStrip);
        });
        top_ += kStrip + 2;
    }

    /// Returns a path through the numbers, with gaps, or through the least and greatest of each
    /// pixel.
    std::string line(const std::vector<float>& values, const Scale& y) const {
        std::string path;
        bool drawn = false;
        const std::size_t per_pixel =
            std::max<std::size_t>(1, values.size() / static_cast<std::size_t>(kInner));
        for (std::size_t first = 0; first < values.size(); first += per_pixel) {
            const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
            const auto end = values.begin() + static_cast<std::ptrdiff_t>(
                                                  std::min(first + per_pixel, values.size()));
            float low = std::numeric_limits<float>::quiet_NaN();
            float high = low;
            for (auto at = begin; at != end; ++at) {
                low = std::fmin(low, std::isfinite(*at) ? *at : low);
                high = std::fmax(high, std::isfinite(*at) ? *at : high);
            }
            const bool known = !std::isnan(low);
            const double at = x(static_cast<double>(first));
            if (known) path += fmt::format("{}{:.1f} {:.1f}", drawn ? "L" : "M", at, y(low));
            if (known && high > low) path += fmt::format("L{:.1f} {:.1f}", at, y(high));
            drawn = known;
        }
        return path;
    }

    void draw_bounds(const Lane& lane, const Scale& y) {
        const auto& lower = lane.lower->values;
        const auto& upper = lane.upper->values;
        const std::size_t stride =
            std::max<std::size_t>(1, lower.size() / static_cast<std::size_t>(kInner));
        std::string above;
        std::string below;
        for (std::size_t i = 0; i < lower.size(); i += stride) {
            if (std::isnan(lower[i])) continue;
            const double at = x(static_cast<double>(i));
            above += fmt::format("{}{:.1f} {:.1f}", above.empty() ? "M" : "L", at, y(upper[i]));
            below = fmt::format("L{:.1f} {:.1f}", at, y(lower[i])) + below;
        }
        body_ += fmt::format("<path class=\"bounds\" d=\"{}{}Z\"/>\n", above, below);
    }

    /// Marks the samples that explain the first alarm, or else the first monitor's verdict.
    void draw_marks(const Lane& lane, const Scale& y) {
        if (why_ == nullptr) return;
        for (const Mark& mark : why_->samples)
            if (mark.is_predicate && mark.index == lane.index)
                rectangle("mark", x(static_cast<double>(mark.first) - 0.5),
                          x(static_cast<double>(mark.last) + 0.5), y.top, kChart);
        const auto& critical = why_->critical;
        if (!critical || !critical->is_predicate || critical->index != lane.index) return;
        const float value = lane.numbers->values[critical->first];
        if (!std::isfinite(value)) return;
        body_ += fmt::format("<circle class=\"critical\" r=\"6\" cx=\"{:.1f}\" cy=\"{:.1f}\"/>\n",
                             x(static_cast<double>(critical->first)), y(value));
    }

    void draw_time() {
        const double seconds = scene_.plan.model->step_seconds;
        const double last = static_cast<double>(tracks_.frames - 1);
        for (int part = 0; part <= 4; ++part) {
            const double step = last * part / 4;
            const double shown = seconds > 0 ? step * seconds : step;
            words(kInner * part / 4, top_ + 8, fmt::format("{:.4g}", shown),
                  part < 4 ? "middle" : "end");  // within the picture
        }
        words(kInner / 2, top_ + 24, seconds > 0 ? "time, s" : "step", "middle");
    }

    const Scene& scene_;
    const Tracks& tracks_;
    const Why* why_;
    std::string body_;
    double top_ = 4;
};

}  // namespace

std::optional<std::string> picture(const Compiled& spec, const std::string& trace,
                                   const episodes::ReadOptions& reading, diag::Sink& sink) {
    const Scene scene{spec.plan, spec.plan.predicates, nullptr, nullptr, reading, {}, {}};
    const auto tracks = TrackReader(scene).score(trace);
    if (tracks) return Drawing(scene, *tracks).text();
    sink.report(recordings::in_trace(tracks.failure(), trace));
    return std::nullopt;
}

}  // namespace etlc::report
