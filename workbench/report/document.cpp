#include "report/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "check/guarantees/guarantees.hpp"
#include "report/distributions.hpp"

namespace etlc::report {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostScores = 400;
constexpr std::uint32_t kMostRows = 400;  ///< of a target that are drawn

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

/// As short as float32 allows: 0.243, not 0.24300000071525574.
Json number(float value) {
    return std::isfinite(value) ? Json(std::stod(fmt::format("{}", value))) : Json();
}

Index declared(const check::Model& model, Index target) {
    const Index source = model.targets[target].source;
    return source == check::kNone ? target : source;
}

/// Where a threshold comes from and what is known of it, in words.
std::string provenance(const check::Predicate& predicate) {
    const check::Threshold& threshold = predicate.threshold;
    if (threshold.origin == check::ThresholdOrigin::literal) return "written in the spec";
    if (threshold.origin == check::ThresholdOrigin::f1)
        return fmt::format("{}, chosen on {}; no guarantee", threshold.text,
                           diag::counted(threshold.n, "labelled frame"));
    const bool of_frames = threshold.origin == check::ThresholdOrigin::class_conditional;
    return fmt::format("{}: beyond score {} of {}, one of each {}", threshold.text, threshold.k,
                       threshold.n, of_frames ? "positive frame" : "demonstration");
}

Json scores_of(const Material& material, const check::Predicate& predicate) {
    if (!material.thresholds) return nullptr;
    const auto found = material.thresholds->predicates.find(predicate.name);
    if (found == material.thresholds->predicates.end() || found->second.k == 0) return nullptr;
    std::vector<double> all = found->second.scores;
    std::sort(all.begin(), all.end());
    const std::size_t stride = (all.size() + kMostScores - 1) / kMostScores;
    Json ranks = Json::array();
    Json scores = Json::array();
    for (std::size_t i = 0; i < all.size(); i += stride) {
        ranks.push_back(i + 1);
        scores.push_back(number(all[i]));
    }
    return {{"alpha", found->second.alpha},
            {"n", found->second.n},
            {"k", found->second.k},
            {"ranks", ranks},
            {"scores", scores}};
}

Json curve_point(const Operating& at) {
    return Json::array({at.false_positive_rate, at.recall, at.precision});
}

Json distribution_of(const Material& material, const check::Predicate& predicate) {
    if (material.judgement == nullptr) return nullptr;
    const auto& labelled = material.judgement->predicates;
    for (std::size_t i = 0; i < labelled.size(); ++i) {
        if (labelled[i].name != predicate.name) continue;
        const auto found = distribution(*material.judgement, i, predicate);
        if (!found) return nullptr;
        Json curve = Json::array();
        for (const Operating& at : found->curve) curve.push_back(curve_point(at));
        return {{"edges", found->edges},
                {"inside", found->inside},
                {"outside", found->outside},
                {"curve", curve},
                {"operating", found->operating ? curve_point(*found->operating) : Json()}};
    }
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
            {"threshold", number(predicate.threshold.value)},
            {"provenance", provenance(predicate)},
            {"target", target},
            {"scores", scores_of(material, predicate)},
            {"distribution", distribution_of(material, predicate)}};
}

Json monitor_json(const check::Model& model, const plan::Monitor& monitor) {
    Json guarantees = Json::array();
    for (const check::Claim& claim : check::claims(model, model.monitors[monitor.index]))
        guarantees.push_back((claim.part.empty() ? "" : "of its part " + claim.part + ": ") +
                             check::text(claim));
    return {{"name", monitor.name},
            {"formula", check::shown(model, model.monitors[monitor.index].formula)},
            {"sliding", monitor.sliding},
            {"horizon", monitor.horizon},
            {"guarantees", guarantees}};
}

Json plane_json(const check::Model& model, const Plane& plane) {
    std::vector<Index> targets;
    for (const check::Distance& distance : model.distances)
        if (distance.point == plane.point &&
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

/// A row is [path, frames, outcomes, missing, judged, parts, buckets, series, pictures]; judged is
/// [wrong monitors, f1, agreement, first error], or null.
Json row_json(const Row& row, const evaluate::EpisodeRow* judged) {
    Json of_truth;
    if (judged != nullptr) {
        const evaluate::Rates rates = evaluate::rates(judged->claims);
        Json error;
        if (judged->first_error) error = {judged->first_error->step, judged->first_error->name};
        of_truth = {judged->wrong, optional_json(rates.f1), optional_json(rates.agreement), error};
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
        const plan::SampleCounts& counts = totals.sample_counts[i];
        inputs.push_back({{"name", plan.model->inputs[plan.inputs[i]].name},
                          {"missing", counts.missing},
                          {"out_of_range", counts.out_of_range},
                          {"held", counts.held}});
    }
    return inputs;
}

}  // namespace

Index declared_target(const check::Model& model, const check::Predicate& predicate) {
    if (!predicate.plain_distance()) return check::kNone;
    return declared(model, model.distances[predicate.expression.index].target);
}

std::string in_script(const std::string& json) {
    std::string text;
    text.reserve(json.size());
    for (const char c : json)
        if (c == '<')
            text += "\\u003c";
        else
            text += c;
    return text;
}

std::string document(const Material& material, const Scene& scene, const Totals& totals,
                     const std::vector<evaluate::EpisodeRow>& judged,
                     const std::vector<Row>& rows) {
    const check::Model& model = *scene.plan.model;
    Json all = {{"spec",
                 {{"name", model.name},
                  {"path", material.file.path()},
                  {"text", std::string(material.file.text())},
                  {"step_seconds", model.step_seconds},
                  {"reservations", model.reservations}}},
                {"has_truth", material.judgement != nullptr},
                {"why_no_truth", material.why_no_truth},
                {"episodes", totals.episodes},
                {"steps", totals.steps},
                {"inputs", inputs_json(scene.plan, totals)}};
    all["predicates"] = Json::array();
    for (const Index p : scene.predicates)
        all["predicates"].push_back(predicate_json(material, scene, p));
    all["monitors"] = Json::array();
    for (const plan::Monitor& monitor : scene.plan.monitors)
        all["monitors"].push_back(monitor_json(model, monitor));
    all["planes"] = Json::array();
    for (const Plane& plane : scene.planes) all["planes"].push_back(plane_json(model, plane));
    all["target_pictures"] = Json::object();
    for (const auto& [target, pictures] : scene.target_pictures)
        all["target_pictures"][model.targets[target].name] = pictures;
    all["rows"] = Json::array();
    for (const Row& row : rows)
        all["rows"].push_back(row_json(row, judged.empty() ? nullptr : &judged[row.rank]));
    return in_script(all.dump(-1, ' ', true, Json::error_handler_t::replace));
}

}  // namespace etlc::report
