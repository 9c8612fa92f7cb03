#include "report/tracks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "check/guarantees/guarantees.hpp"
#include "report/report.hpp"
#include "source/text.hpp"

namespace etlc::report {

namespace {

using check::kNone;
using episodes::Label;
using etlmon::Verdict;

std::uint32_t code_of_label(Label label) {
    return label == Label::yes ? kYes : label == Label::no ? kNo : kUnknown;
}

Outcome outcome_of(const explain::History& history, bool sliding) {
    Outcome outcome;
    outcome.alarm = history.first_alarm;
    outcome.final_at = sliding ? std::nullopt : history.first_final;
    outcome.robustness = std::numeric_limits<float>::infinity();
    for (std::size_t step = 0; step < history.verdicts.size(); ++step) {
        const Verdict& verdict = history.verdicts[step];
        if (!verdict.decided()) continue;
        const std::uint32_t status = code_of(verdict) % kFinal;
        // Every position of a sliding monitor has a verdict, and the worst one counts.
        const bool is_better = status == kYes ? outcome.status <= kUnknown : outcome.status == kNo;
        if (!sliding || !is_better) outcome.status = status;
        outcome.robustness =
            sliding ? std::min(outcome.robustness, verdict.robustness) : verdict.robustness;
    }
    return outcome;
}

bool same_numbers(const Numbers& a, const Numbers& b) {
    return std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(),
                      [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

bool has_row(const check::Predicate& predicate, const check::Model& model) {
    if (!predicate.plain_distance()) return false;
    const check::Distance& distance = model.distances[predicate.expression.index];
    return distance.aggregation == check::Aggregation::min && !distance.is_between_points();
}

/// Adds where a predicate or monitor is first called wrong, and where it is for the last time: the
/// page begins there.
void add_errors(const Tracks& tracks, std::vector<std::uint64_t>& steps) {
    for (const auto& [said_of, true_of] :
         {std::pair("holds", "truth"), {"status", "monitor_truth"}})
        for (const Codes& said : tracks.codes)
            for (const Codes& is : tracks.codes) {
                if (said.of != said_of || is.of != true_of || said.index != is.index) continue;
                std::vector<std::uint64_t> begins;
                bool before = false;
                for (std::size_t step = 0; step < is.values.size(); ++step) {
                    const auto [a, b] =
                        std::minmax({said.values[step] % kFinal, is.values[step] % kFinal});
                    const bool is_wrong = a == kNo && b == kYes;
                    if (is_wrong && !before) begins.push_back(step);
                    before = is_wrong;
                }
                if (!begins.empty()) steps.insert(steps.end(), {begins.front(), begins.back()});
            }
}

}  // namespace

std::uint32_t code_of(const Verdict& verdict) {
    if (!verdict.decided()) return kUndecided;
    const std::uint32_t status = verdict.satisfied() ? kYes : verdict.violated() ? kNo : kUnknown;
    return status + (verdict.final() ? kFinal : 0);
}

std::uint32_t code_of(const std::optional<bool>& called) {
    return !called ? kUnknown : *called ? kYes : kNo;
}

std::vector<std::string> levels(const check::Threshold& threshold) {
    std::vector<std::string> texts;
    for (const float level : std::set{threshold.low(), threshold.value})
        texts.push_back(std::isfinite(level) ? fmt::format("{}", level)
                        : level > 0          ? "Infinity"
                                             : "-Infinity");
    return texts;
}

std::vector<std::uint64_t> telling_steps(const Tracks& tracks) {
    std::vector<std::uint64_t> steps;
    add_errors(tracks, steps);
    for (const Why& why : tracks.reasons) {
        if (why.critical) steps.push_back(why.critical->first);
        steps.push_back(std::min(why.step, tracks.frames - 1));
    }
    for (const Why& why : tracks.reasons)
        for (const Mark& mark : why.samples) steps.insert(steps.end(), {mark.first, mark.last});
    for (const Codes& codes : tracks.codes) {
        if (codes.of == "nearest") continue;
        for (std::size_t step = 1; step < codes.values.size(); ++step)
            if (codes.values[step] != codes.values[step - 1]) steps.push_back(step);
    }
    return steps;
}

TrackReader::TrackReader(const Scene& scene)
    : scene_(scene),
      leaks_(*scene.plan.model, {}),
      program_(ir::lower(*scene.plan.model)),
      monitors_(scene.plan) {
    if (scene.truth != nullptr) truths_.emplace(*scene.truth_plan, &scene.truth->truth);
    for (const plan::Monitor& monitor : scene.plan.monitors) {
        Index of = kNone;
        if (scene.truth != nullptr)
            for (const evaluate::MonitorSubject& subject : scene.truth->monitors)
                if (subject.monitor == monitor.index && subject.lacking.empty()) of = subject.truth;
        truth_of_.push_back(of);
    }
}

episodes::Wanted TrackReader::wanted() const {
    std::vector<const plan::Plan*> plans = {&scene_.plan, &atoms_->plan()};
    std::vector<Index> labelled;
    if (truths_) {
        plans.push_back(scene_.truth_plan);
        labelled = scene_.truth->labelled;
    }
    return episodes::wanted(model(), plans, std::move(labelled), leaks_);
}

void TrackReader::begin(Tracks& tracks) {
    observations_ = std::make_unique<explain::Observations>(model(), scene_.plan.values,
                                                            scene_.predicates, scene_.plan.inputs);
    atoms_.emplace(observations_->plan());
    monitor_tracks_.assign(scene_.plan.monitors.size(), {});
    if (truths_)
        for (std::size_t i = 0; i < scene_.predicates.size(); ++i)
            if (std::binary_search(scene_.truth->labelled.begin(), scene_.truth->labelled.end(),
                                   scene_.predicates[i]))
                tracks.codes.push_back({"truth", i, {}});
    for (std::size_t k = 0; k < scene_.planes.size(); ++k) {
        tracks.numbers.push_back({"x", k, {}});
        tracks.numbers.push_back({"y", k, {}});
    }
}

diag::Result<Tracks> TrackReader::score(const std::string& path) {
    Tracks tracks;
    tracks.path = path;
    begin(tracks);
    auto recording = episodes::Recording::open(wanted(), path, scene_.reading);
    if (!recording) return recording.failure();
    std::vector<episodes::Follower*> followers = {&monitors_, &*atoms_};
    if (truths_) followers.push_back(&*truths_);
    const auto frame = [&] {
        note_frame(*recording, tracks);
        return true;
    };
    const auto rest = [&] {
        for (std::size_t m = 0; m < monitor_tracks_.size(); ++m)
            if (monitors_.reports(scene_.plan.monitors[m].index))
                monitor_tracks_[m].history.add_after_trace(monitors_.verdicts()[m],
                                                           monitors_.evaluator().position(m));
        return true;
    };
    const auto done = episodes::replay(*recording, followers, frame, rest);
    if (!done) return done.failure();
    tracks.frames = recording->frames();
    if (tracks.frames == 0) return recordings::no_steps();
    for (const Index input : scene_.plan.inputs)
        tracks.sample_counts.push_back(monitors_.evaluator().sample_counts()[input]);
    add_measurements(tracks);
    add_verdicts(tracks);
    add_reasons(tracks);
    return tracks;
}

void TrackReader::note_frame(const episodes::Recording& recording, Tracks& tracks) {
    observations_->add(atoms_->evaluator());
    for (std::size_t m = 0; m < monitor_tracks_.size(); ++m) {
        monitor_tracks_[m].history.add(monitors_.verdicts()[m], monitors_.evaluator().position(m));
        if (truth_of_[m] != kNone) note_truth(m);
    }
    for (Codes& track : tracks.codes)
        track.values.push_back(code_of_label(recording.label(scene_.predicates[track.index])));
    for (Numbers& track : tracks.numbers) {
        const Plane& plane = scene_.planes[track.index];
        const float* z = atoms_->evaluator().point(plane.point);
        track.values.push_back(z == nullptr ? std::numeric_limits<float>::quiet_NaN()
                                            : plane(z)[track.of == "x" ? 0 : 1]);
    }
}

/// Records a true verdict, and restarts the truth of a repeating monitor with it.
void TrackReader::note_truth(std::size_t monitor) {
    const plan::Monitor& of = scene_.plan.monitors[monitor];
    const Verdict& is = truths_->verdict(truth_of_[monitor]);
    monitor_tracks_[monitor].truth.push_back(code_of(is));
    if (of.restarts == check::Restarts::when_final && monitors_.verdicts()[monitor].final())
        truths_->restart(truth_of_[monitor]);
}

void TrackReader::add_measurements(Tracks& tracks) const {
    const std::uint64_t steps = observations_->steps();
    for (std::size_t i = 0; i < scene_.predicates.size(); ++i) {
        const Index atom = observations_->atom(true, scene_.predicates[i]);
        Numbers distance{"distance", i, {}};
        Codes holds{"holds", i, {}};
        Codes nearest{"nearest", i, {}};
        const check::Predicate& predicate = model().predicates[scene_.predicates[i]];
        for (std::uint64_t step = 0; step < steps; ++step) {
            const float delta = observations_->measured({atom, step});
            distance.values.push_back(delta);
            holds.values.push_back(code_of(predicate.called(delta)));
        }
        if (has_row(predicate, model()))
            for (std::uint64_t step = 0; step < steps; ++step)
                nearest.values.push_back(observations_->nearest({atom, step}, 0));
        tracks.numbers.push_back(std::move(distance));
        tracks.codes.push_back(std::move(holds));
        if (!nearest.values.empty()) tracks.codes.push_back(std::move(nearest));
    }
    for (std::size_t i = 0; i < scene_.plan.inputs.size(); ++i) {
        const Index input = scene_.plan.inputs[i];
        if (model().inputs[input].type != check::InputType::boolean) continue;
        Codes flags{"input", i, {}};
        for (std::uint64_t step = 0; step < steps; ++step) {
            const float flag = observations_->measured({observations_->atom(false, input), step});
            flags.values.push_back(std::isnan(flag) ? kUnknown : flag != 0 ? kYes : kNo);
        }
        tracks.codes.push_back(std::move(flags));
    }
}

void TrackReader::add_verdicts(Tracks& tracks) const {
    for (std::size_t m = 0; m < monitor_tracks_.size(); ++m) {
        const explain::History& history = monitor_tracks_[m].history;
        tracks.outcomes.push_back(outcome_of(history, scene_.plan.monitors[m].sliding));
        Numbers robustness{"robustness", m, {}};
        Numbers lower{"lower", m, {}};
        Numbers upper{"upper", m, {}};
        Codes status{"status", m, {}};
        for (std::uint64_t step = 0; step < tracks.frames; ++step) {
            const Verdict& verdict = history.verdicts[step];
            robustness.values.push_back(verdict.robustness);
            lower.values.push_back(verdict.lower);
            upper.values.push_back(verdict.upper);
            status.values.push_back(code_of(verdict));
        }
        // A bound that equals the robustness is left out and drawn from it, as always for a sliding
        // monitor.
        for (Numbers* bound : {&lower, &upper})
            if (!scene_.plan.monitors[m].sliding && !same_numbers(*bound, robustness))
                tracks.numbers.push_back(std::move(*bound));
        tracks.numbers.push_back(std::move(robustness));
        tracks.codes.push_back(std::move(status));
        if (!monitor_tracks_[m].truth.empty())
            tracks.codes.push_back({"monitor_truth", m, monitor_tracks_[m].truth});
    }
}

Mark TrackReader::mark(explain::Sample sample, std::uint64_t last, bool holds) const {
    const explain::Atom& atom = observations_->atoms()[sample.atom];
    const std::vector<Index>& all = atom.is_predicate ? scene_.predicates : scene_.plan.inputs;
    const auto at = std::find(all.begin(), all.end(), atom.index);
    return {atom.is_predicate, static_cast<std::size_t>(at - all.begin()), sample.step, last,
            holds};
}

void TrackReader::add_reasons(Tracks& tracks) const {
    for (std::size_t m = 0; m < monitor_tracks_.size(); ++m) {
        const plan::Monitor& monitor = scene_.plan.monitors[m];
        const explain::History& history = monitor_tracks_[m].history;
        const std::uint64_t step = history.usual_step(monitor.sliding, tracks.frames - 1);
        const Verdict& verdict = history.verdicts[step];
        if (!verdict.decided()) continue;
        const explain::Question question{monitor.index, history.positions[step], step};
        const explain::Report report{*observations_, question, verdict.final(),
                                     explain::explain(program_, *observations_, question)};
        const explain::Explanation& found = report.explanation;
        Why why{m,  step, question.position, explain::word(found.status), found.for_good, "",
                {}, {}};
        why.text = explain::text(report);
        for (const explain::Interval& i : explain::intervals(*observations_, found.samples))
            why.samples.push_back(mark({i.atom, i.first}, i.last, i.holds));
        if (found.critical) {
            const explain::Sample at = *found.critical;
            why.critical = mark(at, at.step, observations_->value(at).low >= 0);
        }
        tracks.reasons.push_back(std::move(why));
    }
}

// Draws the timelines of one trace as an SVG picture, for papers and slides (`etlc run --svg`): a
// lane for each predicate and monitor, with its chart and the strips of its predictions and truths,
// as the page shows them. The size does not depend on the number of steps: with more steps than
// pixels, a line goes through the least and the greatest number of each pixel.

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
    ".between{fill:#b34700;fill-opacity:.1}.unknown{fill:url(#unknown)}"
    ".yes{fill:#0072b2}.no{fill:#e4e9ee}.open{fill:#a7b0ba}.violated{fill:#d55e00}"
    ".so-far{fill-opacity:.4}.true{fill:#3d4753}"
    ".mark{fill:#cc79a7;fill-opacity:.3}.critical{fill:none;stroke:#a8447d;stroke-width:2.5}";

constexpr const char* kHatch =
    "<pattern id=\"unknown\" width=\"4\" height=\"4\" patternUnits=\"userSpaceOnUse\" "
    "patternTransform=\"rotate(45)\"><rect width=\"4\" height=\"4\" fill=\"#ffffff\"/>"
    "<line y2=\"4\" stroke=\"#5d6b7c\" stroke-width=\"3\"/></pattern>\n";

struct Lane {
    std::string name;
    std::string text;
    const Numbers* numbers = nullptr;
    const Numbers* lower = nullptr;
    const Numbers* upper = nullptr;
    const Codes* said = nullptr;
    const Codes* truth = nullptr;
    float inner = 0;  ///< called true within it
    float outer = 0;  ///< called false beyond it
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
        const check::Threshold& threshold = predicate.threshold;
        lanes.push_back({predicate.shown(), predicate.text + check::numbers(threshold),
                         find(tracks.numbers, "distance", i), nullptr, nullptr,
                         find(tracks.codes, "holds", i), find(tracks.codes, "truth", i),
                         threshold.low(), threshold.value, false, i});
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
                         0, true, m});
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
            "{3}<g transform=\"translate({4:g},0)\">\n{5}</g>\n</svg>\n",
            kWidth, height, kStyle, kHatch, kLeft, body_);
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
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        std::vector<float> values = lane.numbers->values;
        values.insert(values.end(), {lane.inner, lane.outer});
        for (const float value : values) {
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
        const auto [above, below] = std::minmax({y(lane.inner), y(lane.outer)});
        if (above < below) rectangle("between", 0, kInner, above, below - above);
        body_ +=
            fmt::format("<line class=\"axis\" y1=\"{:g}\" y2=\"{:g}\"/>\n", y.top, y.top + kChart);
        for (const float level : std::set{lane.inner, lane.outer})
            if (std::isfinite(level))
                body_ += fmt::format(
                    "<line class=\"threshold\" x2=\"{0:g}\" y1=\"{1:.1f}\" y2=\"{1:.1f}\"/>\n",
                    kInner, y(level));
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
            std::string kind = status == kYes       ? yes
                               : status == kNo      ? no
                               : status == kUnknown ? "unknown"
                                                    : "open";
            shows_unknown_ |= status == kUnknown;
            if (codes.of == "status" && code < kFinal)
                kind = status == kNo ? "no" : kind + " so-far";
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
        if (!shows_unknown_) return;
        rectangle("unknown", 0, 14, top_ + 17, kStrip);
        words(20, top_ + 24, "unknown");
    }

    const Scene& scene_;
    const Tracks& tracks_;
    const Why* why_;
    std::string body_;
    bool shows_unknown_ = false;
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
