#include "report/document.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "check/guarantees/conformal.hpp"
#include "check/guarantees/guarantees.hpp"

namespace etlc::report {

namespace {

using episodes::Scored;
using Json = nlohmann::ordered_json;

constexpr std::size_t kBins = 60;
constexpr double kPicture = 256;  ///< parts of a side of the curves' drawing
constexpr std::size_t kMostScores = 400;
constexpr std::uint32_t kMostRows = 400;  ///< drawn of a target

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

/// Returns the shortest number for a float32: 0.243, not 0.24300000071525574.
Json number(float value) {
    return std::isfinite(value) ? Json(std::stod(fmt::format("{}", value))) : Json();
}

Index declared(const check::Model& model, Index target) {
    const Index source = model.targets[target].source;
    return source == check::kNone ? target : source;
}

/// Describes the origin of a threshold.
std::string provenance(const check::Predicate& predicate) {
    const check::Threshold& threshold = predicate.threshold;
    if (threshold.origin == check::ThresholdOrigin::literal) return "written in the spec";
    if (threshold.origin == check::ThresholdOrigin::f1)
        return fmt::format("{}, chosen on {}; no guarantee", threshold.text,
                           diag::counted(threshold.n, "labelled frame"));
    return check::origin(threshold);
}

/// Returns the scores of which one gives a threshold, each with its rank.
Json scores_of(const thresholds::Side& side, bool above) {
    const std::size_t count = side.scores.size();
    const std::size_t stride = (count + kMostScores - 1) / kMostScores;
    Json scores = Json::array();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t rank = above ? i + 1 : count - i;
        if (i % stride == 0 || rank == side.k) scores.push_back({number(side.scores[i]), rank});
    }
    return {{"n", side.n}, {"k", side.k}, {"scores", scores}};
}

/// Returns the scores against misses, then those against false positives; or against one of them.
Json scores_of(const Material& material, const check::Predicate& predicate) {
    Json all = Json::array();
    if (!material.thresholds) return all;
    const auto found = material.thresholds->predicates.find(predicate.name);
    if (found == material.thresholds->predicates.end()) return all;
    const thresholds::Entry& entry = found->second;
    if (!check::takes_scores(entry.method)) return all;
    const bool above = check::is_above(predicate.threshold.against, predicate.upper_bound());
    all.push_back(scores_of(entry, above));
    if (entry.inner) all.push_back(scores_of(*entry.inner, !above));
    return all;
}

/// At one threshold: the rates of false and of true positives, and the precision, 1 without
/// predictions.
using Operating = std::array<double, 3>;

/// Returns the labelled frames with finite scores, greatest scores first.
std::vector<Scored> finite_frames(const evaluate::Judgement& judgement, std::size_t i) {
    const auto& folds = judgement.predicates[i].frames;
    std::vector<Scored> frames;
    for (const episodes::FramesByScore& fold : folds)
        fold.for_each([&](const Scored& frame) {
            if (std::isfinite(frame.score)) frames.push_back(frame);
        });
    const auto is_less = [](const Scored& a, const Scored& b) { return a.score < b.score; };
    if (folds.size() > 1) std::sort(frames.begin(), frames.end(), is_less);  // one is sorted
    std::reverse(frames.begin(), frames.end());
    return frames;
}

/// Counts the frames of either truth in bins of distance.
Json histogram(const std::vector<Scored>& frames, bool upper_bound) {
    const auto distance = [&](const Scored& frame) {
        return static_cast<double>(upper_bound ? -frame.score : frame.score);
    };
    const auto [first, last] = std::minmax({distance(frames.front()), distance(frames.back())});
    const double width = last > first ? (last - first) / kBins : 1;
    std::vector<double> edges;
    for (std::size_t bin = 0; bin <= kBins; ++bin)
        edges.push_back(first + width * static_cast<double>(bin));
    std::vector<std::uint64_t> inside(kBins);
    std::vector<std::uint64_t> outside(kBins);
    for (const Scored& frame : frames) {
        const auto bin = static_cast<std::size_t>((distance(frame) - first) / width);
        ++(frame.positive ? inside : outside)[std::min(bin, kBins - 1)];
    }
    return {{"edges", edges}, {"inside", inside}, {"outside", outside}};
}

bool is_drawn_apart(const Operating& a, const Operating& b) {
    return !std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
        return std::lround(x * kPicture) == std::lround(y * kPicture);
    });
}

/// Returns the histogram of the i-th labelled predicate's distances, its ROC and precision-recall
/// curve, from the strictest threshold to the widest, and the points of its own one or two
/// thresholds, ascending. Curves go through every threshold and are thinned to what the drawing
/// shows; frames of unknown distance are left out. Null for an equality, and without a labelled
/// frame of finite distance.
Json distribution(const evaluate::Judgement& judgement, std::size_t i,
                  const check::Predicate& predicate) {
    if (predicate.equality()) return nullptr;
    const std::vector<Scored> frames = finite_frames(judgement, i);
    if (frames.empty()) return nullptr;
    Json result = histogram(frames, predicate.upper_bound());
    Json curve = Json::array();
    const std::set<float> levels{predicate.threshold.low(), predicate.threshold.value};
    Json operating = Json::array();
    const auto with_curve = [&] {
        result["curve"] = curve;
        result["operating"] = operating;
        return result;
    };
    const auto positives = static_cast<double>(
        std::count_if(frames.begin(), frames.end(), [](const Scored& f) { return f.positive; }));
    const double negatives = static_cast<double>(frames.size()) - positives;
    if (positives == 0 || negatives == 0) return with_curve();
    double hits = 0;
    double false_alarms = 0;
    const auto here = [&] {
        const double predictions = hits + false_alarms;
        return Operating{false_alarms / negatives, hits / positives,
                         predictions == 0 ? 1 : hits / predictions};
    };
    Operating drawn = here();
    curve.push_back(drawn);
    operating = Json(levels.size(), Json(drawn));
    for (std::size_t k = 0; k < frames.size(); ++k) {
        (frames[k].positive ? hits : false_alarms) += 1;
        const float score = frames[k].score;
        if (k + 1 < frames.size() && frames[k + 1].score == score) continue;
        const bool is_last = k + 1 == frames.size();
        if (is_last || is_drawn_apart(drawn, here())) {
            drawn = here();
            curve.push_back(drawn);
        }
        const float delta = predicate.upper_bound() ? -score : score;
        std::size_t at = 0;
        for (const float level : levels)
            if (Json& point = operating[at++]; check::holds(predicate.comparison, delta, level))
                point = here();
    }
    return with_curve();
}

Json distribution_of(const Material& material, const check::Predicate& predicate) {
    if (material.judgement == nullptr) return nullptr;
    const auto& labelled = material.judgement->predicates;
    for (std::size_t i = 0; i < labelled.size(); ++i)
        if (labelled[i].name == predicate.name)
            return distribution(*material.judgement, i, predicate);
    return nullptr;
}

Json predicate_json(const Material& material, const Scene& scene, Index index) {
    const check::Model& model = *scene.plan.model;
    const check::Predicate& predicate = model.predicates[index];
    const Index of = declared_target(model, predicate);
    const Json target = of == check::kNone ? Json() : Json(model.targets[of].name);
    return {{"name", predicate.name},
            {"shown", predicate.shown()},
            {"expression", check::print(model, predicate.expression)},
            {"comparison", symbol(predicate.comparison)},
            {"thresholds", levels(predicate.threshold)},
            {"provenance", provenance(predicate)},
            {"target", target},
            {"scores", scores_of(material, predicate)},
            {"distribution", distribution_of(material, predicate)}};
}

/// Returns a card like that of a predicate for a calibrated duration; otherwise null.
Json duration_json(const Material& material, const check::Monitor& monitor) {
    if (!monitor.duration || !material.thresholds) return nullptr;
    const auto found = material.thresholds->monitors.find(monitor.name);
    if (found == material.thresholds->monitors.end() || !found->second.duration) return nullptr;
    const check::Duration& duration = *monitor.duration;
    return {{"shown", monitor.name},
            {"expression", "duration in steps"},
            {"thresholds", Json::array({duration.steps})},
            {"scores", Json::array({scores_of(found->second, duration.longer_is_truer)})}};
}

Json monitor_json(const Material& material, const check::Model& model,
                  const plan::Monitor& monitor) {
    Json guarantees = Json::array();
    for (const check::Guarantee& one : check::guarantees(model, model.monitors[monitor.index]))
        guarantees.push_back(check::text(one));
    const check::Monitor& declared = model.monitors[monitor.index];
    const std::string calibrated = declared.calibration ? check::of_shift(*declared.calibration)
                                   : declared.duration
                                       ? check::of_duration(model, *declared.duration)
                                       : "";
    return {{"name", monitor.name},       {"formula", check::shown(model, declared.formula)},
            {"sliding", monitor.sliding}, {"horizon", monitor.horizon},
            {"calibrated", calibrated},   {"duration", duration_json(material, declared)},
            {"guarantees", guarantees}};
}

Json plane_json(const check::Model& model, const Plane& plane) {
    std::vector<Index> targets;
    for (const check::Distance& distance : model.distances)
        if (distance.point == plane.point && !distance.is_between_points() &&
            std::find(targets.begin(), targets.end(), distance.target) == targets.end())
            targets.push_back(distance.target);
    Json shown = Json::array();
    for (const Index t : targets) {
        const check::Target& target = model.targets[t];
        Json rows = Json::array();
        const std::uint32_t stride = (target.rows + kMostRows - 1) / kMostRows;
        for (std::uint32_t row = 0; row < target.rows; row += stride) {
            const auto at = plane(&target.values[std::size_t{row} * target.dimension]);
            rows.push_back({row, number(at[0]), number(at[1])});
        }
        shown.push_back({{"name", model.targets[declared(model, t)].name}, {"rows", rows}});
    }
    const check::Point& point = model.points[plane.point];
    return {{"point", point.text},
            {"dimension", point.dimension},
            {"by_direction", plane.by_direction},
            {"explained", plane.explained},
            {"targets", shown}};
}

template <class Value>
Json optional_json(const std::optional<Value>& value) {
    return value ? Json(*value) : Json();
}

Json outcomes_json(const Row& row) {
    Json outcomes = Json::array();
    for (const Outcome& outcome : row.outcomes)
        outcomes.push_back({outcome.status, number(outcome.robustness),
                            optional_json(outcome.alarm), optional_json(outcome.final_at)});
    return outcomes;
}

Json pictures_json(const Pictures& pictures) {
    if (pictures.steps.empty()) return nullptr;
    return {{"steps", pictures.steps},
            {"files", pictures.files},
            {"width", pictures.width},
            {"height", pictures.height}};
}

/// Returns [path, frames, outcomes, missing, judged, parts, buckets, series, pictures], where
/// judged is [wrong monitors, shares of wrong and of unknown predictions, first error] or null.
Json row_json(const Row& row, const evaluate::EpisodeRow* judged) {
    Json of_truth;
    if (judged != nullptr) {
        const evaluate::Counts& predictions = judged->predictions;
        Json error;
        if (judged->first_error) error = {judged->first_error->step, judged->first_error->name};
        const auto total = static_cast<double>(predictions.total());
        of_truth = {judged->wrong, number(static_cast<double>(predictions.wrong()) / total),
                    number(static_cast<double>(predictions.unknown()) / total), error};
    }
    return {row.path,
            row.frames,
            outcomes_json(row),
            row.missing,
            of_truth,
            row.blob.parts,
            row.blob.buckets,
            row.blob.text.empty() ? Json() : Json(row.blob.text),
            pictures_json(row.pictures)};
}

Json inputs_json(const plan::Plan& plan, const Totals& totals) {
    Json inputs = Json::array();
    for (std::size_t i = 0; i < plan.inputs.size(); ++i) {
        const execute::SampleCounts& counts = totals.sample_counts[i];
        inputs.push_back({{"name", plan.model->inputs[plan.inputs[i]].name},
                          {"missing", counts.missing},
                          {"out_of_range", counts.out_of_range},
                          {"stale", counts.stale},
                          {"held", counts.held}});
    }
    return inputs;
}

std::string dumped(const Json& json) {
    return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

}  // namespace

Index declared_target(const check::Model& model, const check::Predicate& predicate) {
    if (!predicate.plain_distance() ||
        model.distances[predicate.expression.index].is_between_points())
        return check::kNone;
    return declared(model, model.distances[predicate.expression.index].target);
}

std::string in_script(const std::string& json) {
    std::string text;
    text.reserve(json.size());
    for (std::size_t at = 0;;) {
        const std::size_t found = json.find('<', at);
        text.append(json, at, found - at);
        if (found == std::string::npos) return text;
        text += "\\u003c";
        at = found + 1;
    }
}

std::string predicates(const Material& material, const Scene& scene) {
    Json all = Json::array();
    for (const Index p : scene.predicates) all.push_back(predicate_json(material, scene, p));
    return dumped(all);
}

std::string head(const Material& material, const Scene& scene, const std::string& predicates,
                 const Totals& totals) {
    const check::Model& model = *scene.plan.model;
    const Json first = {{"spec",
                         {{"name", model.name},
                          {"path", material.file.path()},
                          {"text", std::string(material.file.text())},
                          {"step_seconds", model.step_seconds},
                          {"reservations", model.reservations}}},
                        {"has_truth", material.judgement != nullptr},
                        {"why_no_truth", material.why_no_truth},
                        {"episodes", totals.episodes},
                        {"steps", totals.steps},
                        {"unknown", totals.unknown},
                        {"inputs", inputs_json(scene.plan, totals)}};
    Json rest;
    rest["monitors"] = Json::array();
    for (const plan::Monitor& monitor : scene.plan.monitors)
        rest["monitors"].push_back(monitor_json(material, model, monitor));
    rest["planes"] = Json::array();
    for (const Plane& plane : scene.planes) rest["planes"].push_back(plane_json(model, plane));
    rest["target_pictures"] = Json::object();
    for (const auto& [target, pictures] : scene.target_pictures)
        rest["target_pictures"][model.targets[target].name] = pictures;
    std::string text = dumped(first);
    text.back() = ',';  // in place of its bracket
    text += "\"predicates\":" + predicates + ',';
    text.append(dumped(rest), 1);
    text.back() = ',';
    return in_script(text + "\"rows\":[");
}

std::string text_of(const Row& row, const evaluate::EpisodeRow* judged) {
    return in_script(dumped(row_json(row, judged)));
}

const PageFile& page_file(const std::vector<PageFile>& files, std::string_view name) {
    return *std::find_if(files.begin(), files.end(),
                         [&](const PageFile& file) { return file.name == name; });
}

std::string hash_source(const PageFile& file) {
    std::string bytes;
    for (std::size_t i = 0; i < file.sha256.size(); i += 2)
        bytes += static_cast<char>(std::stoi(std::string(file.sha256.substr(i, 2)), nullptr, 16));
    return "'sha256-" + base64(bytes) + "'";
}

std::string filled(std::string_view frame,
                   const std::map<std::string, std::string, std::less<>>& parts) {
    std::string text;
    for (std::size_t at = 0;;) {
        const std::size_t open = frame.find("{{", at);
        text += frame.substr(at, open - at);
        if (open == std::string_view::npos) return text;
        const std::size_t close = frame.find("}}", open);
        text += parts.find(frame.substr(open + 2, close - open - 2))->second;
        at = close + 2;
    }
}

Frame frame_of(const std::string& figures) {
    constexpr std::string_view kData = "{{data}}";
    const auto& files = page_files();
    const PageFile& d3 = page_file(files, "d3.js");
    const PageFile& script = page_file(files, "page.js");
    const PageFile& style = page_file(files, "page.css");
    const std::map<std::string, std::string, std::less<>> parts{
        {"style", std::string(style.text)},
        {"style-hash", hash_source(style)},
        {"d3", std::string(d3.text)},
        {"d3-licence", std::string(page_file(files, "d3_licence.txt").text)},
        {"script", std::string(script.text)},
        {"script-hashes", hash_source(d3) + " " + hash_source(script)},
        {"figures", figures}};
    const std::string_view page = page_file(files, "page.html").text;
    const std::size_t at = page.find(kData);
    return {filled(page.substr(0, at), parts), filled(page.substr(at + kData.size()), parts)};
}

std::string what_is_missing() {
    const auto& files = page_files();
    const bool draws = std::any_of(files.begin(), files.end(),
                                   [](const PageFile& file) { return file.name == "d3.js"; });
    return draws ? ""
                 : "this etlc was built without the library that draws its pages: install "
                   "libjs-d3 and build it again";
}

}  // namespace etlc::report
