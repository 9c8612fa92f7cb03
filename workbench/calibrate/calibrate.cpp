#include "calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>

#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/guarantees/provenance.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"

namespace etlc::calibrate {

namespace {

using check::ThresholdOrigin;
using diag::Code;
using diag::counted;

thresholds::Entry entry_of_predicate(const check::Model& model, Index predicate,
                                     const Evidence& evidence, const Sides& fitted) {
    const check::Labelling labelling{evidence.demonstrations, {{predicate, evidence.from_array}}};
    return entry_of(model.predicates[predicate].threshold, fitted,
                    check::reads(model, predicate, labelling));
}

/// Returns the predicates with labels in the first demonstration. Calibration needs only those of
/// calibrated ones, so one that cannot be read is reported with the others, later.
std::vector<Index> labelled_anywhere(const check::Model& model, const Request& request) {
    diag::Sink sink;
    return episodes::labelled_in_first(model, request, sink).value_or(std::vector<Index>{});
}

}  // namespace

std::optional<Sides> fit_all(const check::Model& model, const Subject& of, diag::Sink& sink) {
    const std::size_t errors = sink.errors();
    Sides sides;
    for (const Aim& aim : aims_of(of.predicate)) {
        const Fit found = fit(of.predicate, aim, of.evidence);
        if (const auto* refusal = std::get_if<Refusal>(&found)) {
            refuse(model, of, aim, *refusal, sink);
        } else if (const auto* out = std::get_if<OutOfRange>(&found)) {
            sink.report(Code::start_out_of_range, of.predicate.threshold.span,
                        check::outside(of.predicate, out->epsilon))
                .note("give it lo and hi with room on both sides of the threshold");
        } else {
            sides.push_back(std::get<Fitted>(found));
        }
    }
    if (sink.errors() > errors) return std::nullopt;
    if (std::all_of(sides.begin(), sides.end(),
                    [](const Fitted& side) { return std::isinf(side.epsilon); })) {
        refuse_both(of, sink);
        return std::nullopt;
    }
    return sides;
}

std::optional<Calibration> calibrate(const check::Model& model, const Request& request,
                                     diag::Sink& sink) {
    const std::vector<Index> predicates = calibrated_predicates(model);
    if (predicates.empty()) {
        sink.report(Code::nothing_to_calibrate, model.monitors.front().span,
                    "nothing in this spec is calibrated")
            .note(
                "write a calibrated threshold as: predicate p = min l2(z, t) <= "
                "calibrated(conformal, "
                "alpha = 0.1);");
        return std::nullopt;
    }
    if (!episodes::can_be_dealt(request.episodes, request.reading, request.folds, model, sink))
        return std::nullopt;
    const std::vector<Guaranteed> guarantees = guaranteed(model, false);
    const Watched watched = watched_by(model, guarantees, with_labels(model, predicates),
                                       labelled_anywhere(model, request));
    Tracks tracks;
    bool is_complete = true;
    bool is_divided = true;
    episodes::Identities demonstrations;
    episodes::Groups groups;
    std::vector<Evidence> evidence(predicates.size());
    std::uint64_t frames = 0;
    const bool all_normal = with_labels(model, predicates).empty();
    const auto take = [&](const Demonstration& demonstration) {
        if (all_normal && !demonstration.outcome.is_demonstration()) {
            for (Evidence& of : evidence) ++of.failures;
            return;
        }
        demonstrations.add(demonstration);
        const std::uint32_t group = groups.add(demonstration.group);
        frames += demonstration.frames;
        tracks.add(demonstration.track);
        is_complete &= demonstration.is_complete;
        is_divided &= demonstration.is_divided;
        for (std::size_t i = 0; i < predicates.size(); ++i)
            if (leaves_out(model.predicates[predicates[i]].threshold, demonstration))
                ++evidence[i].failures;
            else
                evidence[i].add(demonstration.scores[i], group);
    };
    if (!score_demonstrations(model, predicates, watched, request, take, sink)) return std::nullopt;
    episodes::warn_of_unmarked(demonstrations, sink);
    const thresholds::Allowance allowance =
        episodes::admit(model, demonstrations, {}, request.fitted, request.allow_overlap, sink);
    if (sink.has_errors()) return std::nullopt;

    Calibration result;
    result.file.spec = model.name;
    result.file.etlc = request.version;
    check::Model calibrated = model;
    episodes::record(demonstrations, allowance, result.file);
    for (const thresholds::Allowance& used : result.file.allowances)
        calibrated.reservations.push_back(thresholds::text(used));
    std::vector<Sides> all;
    std::vector<Subject> subjects;
    for (std::size_t i = 0; i < predicates.size(); ++i) {
        const check::Predicate& predicate = model.predicates[predicates[i]];
        subjects.push_back({predicate, evidence[i], false, groups.are_named()});
        const auto sides = fit_all(model, subjects.back(), sink);
        if (!sides) continue;
        all.push_back(*sides);
        warn_of_doubts(predicate, evidence[i], sides->front().epsilon, sink);
        check::Threshold& threshold = calibrated.predicates[predicates[i]].threshold;
        set(threshold, predicate, *sides);
        if (threshold.adaptation)
            threshold.value =
                *check::start(*threshold.adaptation, threshold.value, predicate.upper_bound());
        threshold.by_group =
            groups.are_named() && check::takes_groups(check::method_name(threshold.origin));
        result.file.predicates[predicate.name] =
            entry_of_predicate(model, predicates[i], evidence[i], all.back());
        if (is_normal(threshold))
            result.file.predicates[predicate.name].measured =
                measured_scores(evidence[i], predicate.upper_bound());
    }
    if (sink.has_errors()) return std::nullopt;
    demonstrations.for_each([&](std::size_t, const episodes::Recorded& demonstration) {
        result.file.episodes.push_back(episodes::hash_of(demonstration));
    });
    std::vector<LeftOut> out;
    for (std::size_t i = 0; i < predicates.size(); ++i)
        out.push_back(
            left_out(model.predicates[predicates[i]], evidence[i], demonstrations, groups));
    const Others others{guarantees, other_errors(calibrated, predicates, evidence, out, groups),
                        other_errors(calibrated, guarantees, predicates, out,
                                     {tracks, watched, groups, is_complete, is_divided})};
    for (std::size_t i = 0; i < guarantees.size(); ++i)
        warn_of_empty(model, guarantees[i], others.by_guarantee[i], sink);
    result.report = report(calibrated, predicates, evidence, groups, frames, all, others) +
                    report_of_folds(subjects, demonstrations, groups, request.folds) +
                    episodes::remark_on(allowance);
    return result;
}

}  // namespace etlc::calibrate
