// Prints the report of `etlc fit`.
#include <fmt/format.h>

#include <algorithm>

#include "data/text/text.hpp"
#include "fit/algebra/linear.hpp"
#include "fit/fit.hpp"

namespace etlc::fit {

namespace {

using check::Fitted;
using check::FittedMethod;
using diag::counted;

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

std::string figure(const std::optional<episodes::Auroc>& auroc) {
    if (!auroc) return "-";
    if (!auroc->interval) return fmt::format("{:.3f}", auroc->value);
    return fmt::format("{:.3f} [{:.3f}, {:.3f}]", auroc->value, auroc->interval->low,
                       auroc->interval->high);
}

std::string table(const check::Model& model, const std::vector<Separation>& all) {
    std::size_t width = std::string_view("predicate").size();
    for (const Separation& one : all)
        width = std::max(width, model.predicates[one.predicate].name.size());
    std::string text = fmt::format("  {:{}}  {:20}  {}\n", "predicate", width, "plain", "fitted");
    for (const Separation& one : all)
        text += fmt::format("  {:{}}  {:20}  {}\n", model.predicates[one.predicate].name, width,
                            figure(one.before), figure(one.after));
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
            collection.readings.episodes()[frame.episode].path, frame.step, frame.positive,
            frame.positive ? "below" : "above", 100 * (1 - frame.ordered), !frame.positive);
    return text;
}

}  // namespace

std::string report(const check::Model& model, const Collection& collection,
                   const std::vector<Solution>& solutions, const Separations& separations) {
    std::uint64_t frames = 0;
    for (const episodes::Recorded& episode : collection.readings.episodes())
        frames += episode.frames;
    std::string text = fmt::format("Fitted on {}, {}:\n",
                                   counted(collection.readings.episodes().size(), "episode"),
                                   counted(frames, "frame"));
    if (const auto& others = collection.readings.unlabelled(); !others.empty())
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

}  // namespace etlc::fit
