#include "check/guarantees/provenance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "check/guarantees/guarantees.hpp"
#include "check/model/fingerprint.hpp"
#include "data/arrays/array.hpp"

namespace etlc::check {

namespace {

using Hashes = std::map<std::string, std::string>;

/// Samples used unchanged need no hash: the rest of the declaration is part of the episode.
void add_input(const Input& input, Hashes& hashes) {
    const bool narrowed = input.type == InputType::f16 || input.type == InputType::i8;
    if (!narrowed && !input.has_range && !input.has_state()) return;
    std::vector<std::uint64_t> kind{static_cast<std::uint64_t>(input.type), input.hold};
    if (input.stale_after > 0) kind.push_back(input.stale_after);
    hashes[input.name] = data::content_hash(kind, {input.scale, input.range.low, input.range.high});
}

/// Adds the encoder of the input, if it has one.
void add_encoder(const Model& model, Index input, Hashes& hashes) {
    if (const Index encoder = model.inputs[input].encoder; encoder != kNone)
        hashes[model.encoders[encoder].name] = model.encoders[encoder].fingerprint;
}

/// Adds the projections that a point went through, and those of its parts.
void add_projections(const Model& model, Index index, Hashes& hashes) {
    const Point& point = model.points[index];
    if (point.is_projected()) {
        const Projection& projection = model.projections[point.projection];
        hashes[projection.name] = projection.hash;
    }
    if (point.inner != kNone) add_projections(model, point.inner, hashes);
    for (const Index part : point.parts) add_projections(model, part, hashes);
}

void add_target(const Model& model, Index index, Hashes& hashes) {
    const Target& target = model.targets[index];
    const Target& declared = target.source == kNone ? target : model.targets[target.source];
    hashes[declared.name] = declared.hash;
}

void add_predicate(const Model& model, Index predicate, Hashes& hashes) {
    for_each_distance(model.predicates[predicate].expression, [&](Index index) {
        const Distance& distance = model.distances[index];
        add_projections(model, distance.point, hashes);
        if (distance.is_between_points())
            add_projections(model, distance.other, hashes);
        else
            add_target(model, distance.target, hashes);
        if (!distance.weights.empty()) hashes[distance.text] = weights_hash(distance);
    });
    for (const Index input : model.predicates[predicate].inputs) {
        add_input(model.inputs[input], hashes);
        add_encoder(model, input, hashes);
    }
}

/// Returns the indices in all atoms of one kind in a formula.
std::set<Index> atoms_in(const Model& model, Index formula, Formula::Kind kind) {
    std::set<Index> found;
    for (const Index i : parts_of(model, formula))
        if (model.formulas[i].kind == kind) found.insert(model.formulas[i].index);
    return found;
}

void add_flags(const Model& model, Index formula, Hashes& hashes) {
    for (const Index input : atoms_in(model, formula, Formula::Kind::boolean_input))
        add_input(model.inputs[input], hashes);
}

/// Returns the lets whose names occur in the text of a formula.
std::vector<const Let*> lets_in(const Model& model, Index formula) {
    std::vector<const Let*> found;
    if (lets_are_written_out(model, formula)) return found;
    const std::vector<Index> parts = parts_of(model, formula);
    for (const Let& let : model.lets)
        if (std::binary_search(parts.rbegin(), parts.rend(), let.formula)) found.push_back(&let);
    return found;
}

/// Returns the formula, then the definitions of its names: "held && far where held = gripper >
/// 0.5".
std::string text_with_definitions(const Model& model, Index formula) {
    std::string text = print(model, formula);
    std::string_view separator = " where ";
    const auto epsilon = [](const Threshold& threshold) {
        const bool literal = threshold.origin == ThresholdOrigin::literal;
        return literal ? threshold.text
                       : fmt::format("{:.9g} from {}", threshold.value, threshold.text);
    };
    const auto define = [&](const std::string& name, const std::string& definition) {
        text += separator;
        text += name + " = " + definition;
        separator = ", ";
    };
    for (const Index index : predicates_of(model, formula)) {
        const Predicate& predicate = model.predicates[index];
        if (!predicate.name.empty())
            define(predicate.name, predicate.text + epsilon(predicate.threshold));
    }
    for (const Let* const let : lets_in(model, formula))
        if (let->formula != formula) define(let->name, print(model, let->formula));
    return text;
}

/// Prefixes of a truth that arrays replaced; no formula contains them.
constexpr std::string_view kInPlaceOf = "array in place of ";
constexpr std::string_view kBeside = "array or ";

/// Returns what defines the predicate's labels: a truth, its own comparison, or nothing in the
/// spec.
std::string meaning(const Model& model, Index predicate, const Provenance& of) {
    if (!is_own_truth(model, predicate)) return of.truth;
    return of.predicate + model.predicates[predicate].threshold.text;
}

}  // namespace

std::string labels(const std::string& truth, Index predicate, const Labelling& labelling) {
    const auto found = labelling.from_arrays.find(predicate);
    const std::size_t arrays = found == labelling.from_arrays.end() ? 0 : found->second;
    if (truth.empty()) return "array";
    if (arrays == 0) return truth;
    return std::string(arrays == labelling.episodes ? kInPlaceOf : kBeside) + truth;
}

std::string stated(std::string labels) {
    if (labels == "array") return "";
    for (const std::string_view phrase : {kInPlaceOf, kBeside})
        for (std::size_t at = 0; (at = labels.find(phrase, at)) != std::string::npos;)
            labels.erase(at, phrase.size());
    return labels;
}

Provenance provenance(const Model& model, Index predicate) {
    Provenance result;
    result.predicate = model.predicates[predicate].text;
    result.reads = reads(model, predicate);
    add_predicate(model, predicate, result.targets);
    for (const Truth& truth : model.truths) {
        if (truth.predicate != predicate || truth.formula == kNone) continue;
        result.truth = text_with_definitions(model, truth.formula);
        for (const Index index : predicates_of(model, truth.formula))
            add_predicate(model, index, result.truth_targets);
        add_flags(model, truth.formula, result.truth_targets);
    }
    return result;
}

std::vector<Index> predicates_of(const Model& model, Index formula) {
    const std::set<Index> found = atoms_in(model, formula, Formula::Kind::predicate);
    return {found.begin(), found.end()};
}

std::vector<Index> predicates_of(const Model& model, const Monitor& monitor) {
    std::set<Index> found = atoms_in(model, monitor.formula, Formula::Kind::predicate);
    found.merge(atoms_in(model, monitor.true_formula(), Formula::Kind::predicate));
    return {found.begin(), found.end()};
}

std::vector<Index> flags_of(const Model& model, Index formula) {
    const std::set<Index> found = atoms_in(model, formula, Formula::Kind::boolean_input);
    return {found.begin(), found.end()};
}

Provenance provenance(const Model& model, const Monitor& monitor, const Labelling& labelling) {
    Provenance result;
    result.reads = reads(model, monitor);
    result.predicate = text_with_definitions(model, monitor.formula);
    add_flags(model, monitor.formula, result.targets);
    if (monitor.truth != kNone) {
        result.truth = print(model, monitor.truth);
        add_flags(model, monitor.truth, result.targets);
    }
    for (const Index predicate : predicates_of(model, monitor)) {
        Provenance of = provenance(model, predicate);
        result.targets.merge(of.targets);
        result.targets.merge(of.truth_targets);
        if (model.predicates[predicate].name.empty()) continue;
        if (!result.truth.empty()) result.truth += "; ";
        result.truth += model.predicates[predicate].name + ": " +
                        labels(meaning(model, predicate, of), predicate, labelling);
    }
    return result;
}

FittedProvenance provenance(const Model& model, const Fitted& fitted, const Labelling& labelling) {
    FittedProvenance result;
    result.reads = reads(model, fitted);
    Hashes maps;
    add_projections(model, fitted.point, maps);
    for (const Index input : model.points[fitted.point].inputs) add_encoder(model, input, maps);
    result.of = model.points[fitted.point].text;
    for (const auto& [name, hash] : maps) result.of += fmt::format(", {} = {}", name, hash);
    if (fitted.where == kNone) {
        result.truth = "true";
        return result;
    }
    Hashes measured;
    result.truth = print(model, fitted.where);
    for (const Let* const let : lets_in(model, fitted.where))
        result.truth += fmt::format("; {} = {}", let->name, print(model, let->formula));
    add_flags(model, fitted.where, measured);
    for (const Index predicate : predicates_of(model, fitted.where)) {
        Provenance of = provenance(model, predicate);
        measured.merge(is_own_truth(model, predicate) ? of.targets : of.truth_targets);
        if (!model.predicates[predicate].name.empty())
            result.truth +=
                fmt::format("; {}: {}", model.predicates[predicate].name,
                            labels(meaning(model, predicate, of), predicate, labelling));
    }
    for (const auto& [name, hash] : measured) result.truth += fmt::format("; {} = {}", name, hash);
    return result;
}

}  // namespace etlc::check
