#include "fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check/guarantees/provenance.hpp"
#include "data/text/text.hpp"
#include "episodes/admission/admission.hpp"
#include "fit/separation.hpp"
#include "fit/solve.hpp"

namespace etlc::fit {

namespace {

using check::Fitted;
using check::FittedMethod;
using diag::Code;
using diag::counted;

void nothing_to_fit(const check::Model& model, diag::Sink& sink) {
    sink.report(Code::nothing_to_fit, model.monitors.front().span, "nothing in this spec is fitted")
        .note(
            "a fitted target is written: target anchors = fitted(medoids, k = 8, of = z, where = "
            "holds);");
}

void warn_of_constants(const check::Model& model, const Fitted& fitted, const Solution& solution,
                       diag::Sink& sink) {
    if (solution.constant == 0) return;
    const std::uint32_t all = model.points[fitted.point].dimension;
    episodes::warn_of_data(
        Code::constant_features,
        fmt::format("{} of {} of {} {} the same at all frames that '{}' is fitted on",
                    solution.constant, counted(all, "element"), model.points[fitted.point].text,
                    solution.constant == 1 ? "is" : "are", fitted.name),
        fitted.span, sink)
        .note("their values elsewhere are unknown: check how the embedding is made");
}

/// Returns whether `a` is less than `b` by more than the intervals of both, and by enough to
/// matter: intervals of nearly perfect figures are tiny. They are of the same episodes, so their
/// errors mostly agree, and the true confidence is higher.
bool surely_less(const episodes::Figure& a, const episodes::Figure& b) {
    constexpr double kMatters = 0.01;
    if (!a.interval || !b.interval) return false;
    return *b.value - *a.value >
           std::max(kMatters, std::hypot(a.interval->high - *a.value, *b.value - b.interval->low));
}

void warn_of_doubts(const check::Predicate& predicate, const Separation& separation,
                    diag::Sink& sink) {
    // On held-out frames, what was fitted to noise is below 0.5 too.
    constexpr double kBelowNoise = 0.25;
    const episodes::Figure& plain = separation.before;
    const episodes::Figure& fitted = separation.after;
    const bool is_low = fitted.interval && fitted.interval->high < kBelowNoise;
    if (episodes::warn_of_labels(predicate, separation.labels, is_low ? fitted : episodes::Figure{},
                                 sink) ||
        !surely_less(fitted, plain))
        return;
    episodes::warn_of_data(
        Code::fit_makes_worse,
        fmt::format("'{}' separates frames worse with the fit than by the plain distance: "
                    "the area under the ROC curve is {:.2f}, and {:.2f} without a fit",
                    predicate.name, *fitted.value, *plain.value),
        predicate.threshold.span, sink)
        .note(
            "look at what 'where' chooses, and whether there are enough episodes for what is "
            "fitted; or measure from the plain point");
}

/// Reports warnings, and returns false where a fit is refused.
bool report(const Filled& all, diag::Sink& sink) {
    const auto first = all.refusals.begin();
    const std::size_t fitted = first == all.refusals.end() ? all.solutions.size() : first->first;
    for (std::size_t i = 0; i < fitted; ++i)
        warn_of_constants(all.model, all.model.fitted[i], all.solutions[i], sink);
    if (fitted == all.solutions.size()) return true;
    const Fitted& refused = all.model.fitted[fitted];
    sink.report(first->second.code, refused.span,
                fmt::format("'{}' cannot be fitted: {}", refused.name, first->second.message));
    return false;
}

fitted::Entry entry_of(const check::Model& model, const Fitted& fitted, const Solution& solution,
                       const Collection& collection) {
    fitted::Entry entry;
    entry.name = fitted.name;
    entry.declaration = fitted.declaration;
    entry.reads = check::reads(model, fitted, collection.recordings.labelling());
    entry.rows = fitted.rows;
    entry.columns = fitted.columns;
    entry.matrix = solution.filling.matrix;
    entry.offset = solution.filling.offset;
    entry.hash = fitted::content_hash(entry);
    entry.frames = solution.counts.holds;
    for (const Source* source : solution.medoids)
        entry.medoids.push_back(
            {hash_of(collection.recordings.episodes()[source->episode]), source->frame.step});
    return entry;
}

std::string declared(const Fitted& fitted) {
    switch (fitted.slot) {
        case Fitted::Slot::target:
            return fmt::format("target {} = {}", fitted.name, fitted.declaration);
        case Fitted::Slot::projection:
            return fmt::format("projection {} = {}", fitted.name, fitted.declaration);
        case Fitted::Slot::metric: break;
    }
    return fmt::format("mahalanobis({})", fitted.declaration);
}

std::string how(const Fitted& fitted, const Solution& solution) {
    const std::string frames = counted(solution.counts.holds, "frame");
    switch (fitted.method) {
        case FittedMethod::mean: return fmt::format("the mean of {}", frames);
        case FittedMethod::kmeans:
            return fmt::format("the centres of {}, of {} taken evenly",
                               counted(solution.taken, "frame"), solution.counts.holds);
        case FittedMethod::medoids:
            return fmt::format("the frames nearest to the centres of {}, of {} taken evenly",
                               counted(solution.taken, "frame"), solution.counts.holds);
        case FittedMethod::pca:
        case FittedMethod::whitened_pca:
            return fmt::format("{:.1f} % of the variance of {}", 100 * *solution.explained, frames);
        case FittedMethod::discriminant:
            return fmt::format("between {} and {} others; shrinkage {}, chosen by cross-validation",
                               frames, solution.counts.others, *solution.shrinkage);
        case FittedMethod::logpzo: break;
    }
    return fmt::format("mean and covariance of {}", frames);
}

std::string fitted_report(const Fitted& fitted, const Solution& solution) {
    std::string text = fmt::format("  {}\n    {}, in {}\n", declared(fitted), how(fitted, solution),
                                   counted(solution.counts.episodes, "episode"));
    if (solution.counts.missing > 0)
        text += fmt::format("    {} left out: the point is missing\n",
                            counted(solution.counts.missing, "frame"));
    if (solution.counts.unknown > 0)
        text += fmt::format("    {} left out: a missing sample leaves open whether 'where' holds\n",
                            counted(solution.counts.unknown, "frame"));
    return text;
}

std::string table(const check::Model& model, const std::vector<Separation>& all) {
    std::size_t width = std::string_view("predicate").size();
    for (const Separation& one : all)
        width = std::max(width, model.predicates[one.predicate].name.size());
    std::string text = fmt::format("  {:{}}  {:20}  {}\n", "predicate", width, "plain", "fitted");
    for (const Separation& one : all)
        text += fmt::format("  {:{}}  {:20}  {}\n", model.predicates[one.predicate].name, width,
                            shown(one.before), shown(one.after));
    return text;
}

std::string worst_frames(const check::Model& model, const Collection& collection,
                         const Separation& separation) {
    if (separation.worst.empty()) return "";
    const std::string& name = model.predicates[separation.predicate].name;
    std::string text = fmt::format("Worst frames of '{}', one per episode:\n", name);
    for (const WorstFrame& frame : separation.worst)
        text += fmt::format(
            "  {} step {}: labelled {}, but ranks {} {:.0f} % of those labelled {}\n",
            collection.recordings.episodes()[frame.episode].path, frame.step, frame.positive,
            frame.positive ? "below" : "above", 100 * (1 - frame.ordered), !frame.positive);
    return text;
}

/// Reports what was fitted, on which frames, and how well it separates. `solutions`: per fitted
/// thing.
std::string report(const check::Model& model, const Collection& collection,
                   const std::vector<Solution>& solutions, const Separations& separations) {
    std::uint64_t frames = 0;
    for (const episodes::Recorded& episode : collection.recordings.episodes())
        frames += episode.frames;
    std::string text = fmt::format("Fitted on {}, {}:\n",
                                   counted(collection.recordings.episodes().size(), "episode"),
                                   counted(frames, "frame"));
    if (const auto& others = collection.recordings.unlabelled(); !others.empty())
        text += fmt::format("{} without labels left out: {}\n", counted(others.size(), "episode"),
                            data::listed(others));
    for (std::size_t i = 0; i < solutions.size(); ++i)
        text += fitted_report(model.fitted[i], solutions[i]);
    if (!separations.why_not.empty())
        return text + fmt::format(
                          "\nIts separation is unknown, because it cannot be fitted on a part of "
                          "the episodes: {}\n",
                          separations.why_not);
    if (separations.all.empty())
        return text + "\nIts separation is unknown: no predicate that uses it has a truth\n";
    text += fmt::format(
        "\nArea under the ROC curve by frame, on episodes that were not fitted on ({}),\n"
        "with the 95 % interval over episodes; 0.5 is chance:\n{}"
        "plain: l2 to the mean of the frames at which the predicate holds, without any map\n",
        counted(collection.folds.size(), "fold"), table(model, separations.all));
    for (const Separation& one : separations.all) {
        const std::string worst = worst_frames(model, collection, one);
        if (!worst.empty()) text += "\n" + worst;
    }
    return text;
}

}  // namespace

std::optional<Fit> fit(const check::Model& model, const Request& request, diag::Sink& sink) {
    if (model.fitted.empty()) {
        nothing_to_fit(model, sink);
        return std::nullopt;
    }
    const std::vector<std::string>& paths = request.episodes;
    fix_order_of_sums();
    const auto labelled = episodes::labelled_in(model, paths.front(), request.reading);
    if (!labelled) {
        sink.report(recordings::in_trace(labelled.failure(), paths.front()));
        return std::nullopt;
    }
    Needs needs = needs_of(model);
    std::vector<Index> predicates;
    if (request.separation) predicates = separating_predicates(model, *labelled);
    for (const Index predicate : predicates)
        if (const auto need = plain_need(model, predicate)) needs.add(*need);
    std::vector<Measured> measured;
    for (const Index predicate : predicates) measured.push_back({predicate, predicate});
    const auto collection = collect(model, needs.all, measured, request, sink);
    if (!collection) return std::nullopt;
    const auto recorded = episodes::recorded(collection->recordings.episodes());
    episodes::warn_of_unmarked(recorded, sink);
    const thresholds::Allowance allowance =
        episodes::admit(model, recorded, {}, {}, request.allow_overlap, sink);
    if (sink.has_errors()) return std::nullopt;

    Solver solver(*collection, needs);
    const FilledAll filled = fill_all(model, solver, true, !predicates.empty(), request.jobs);
    const Filled& all = *filled.all;
    if (!report(all, sink)) return std::nullopt;
    const auto separations = separate(filled.without, solver, measured, request, sink);
    if (!separations) return std::nullopt;
    for (const Separation& one : separations->all)
        warn_of_doubts(model.predicates[one.predicate], one, sink);

    Fit result;
    result.file.spec = model.name;
    result.file.etlc = request.version;
    for (std::size_t i = 0; i < all.solutions.size(); ++i)
        result.file.entries[all.model.fitted[i].name] =
            entry_of(all.model, all.model.fitted[i], all.solutions[i], *collection);
    for (const episodes::Recorded& episode : collection->recordings.episodes())
        result.file.episodes.push_back(hash_of(episode));
    episodes::record(recorded, allowance, result.file);
    result.report = report(all.model, *collection, all.solutions, *separations);
    for (const thresholds::Allowance& used : result.file.allowances)
        result.report += fmt::format("\n{}\n", thresholds::text(used));
    result.report += episodes::remark_on(allowance);
    return result;
}

}  // namespace etlc::fit
