#include "fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "check/guarantees/provenance.hpp"
#include "data/files/file.hpp"
#include "episodes/admission.hpp"

namespace etlc::fit {

namespace {

using check::Fitted;
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
    // Of the data: of the spec nothing is wrong.
    diag::Diagnostic found = data::in_file(
        {Code::constant_features,
         fmt::format("{} of {} of {} {} the same at all frames that '{}' is fitted on",
                     solution.constant, counted(all, "element"), model.points[fitted.point].text,
                     solution.constant == 1 ? "is" : "are", fitted.name)},
        "--data");
    found.span = fitted.span;
    sink.report(std::move(found))
        .note("what they would be elsewhere, nobody knows: look at how the embedding is made");
}

/// Every fitted thing in order, put into the model. Nothing where one is refused.
std::optional<std::vector<Solution>> solve_all(check::Model& model, const Needs& needs,
                                               const Collection& collection, diag::Sink& sink) {
    std::vector<Solution> solutions;
    for (Index i = 0; i < model.fitted.size(); ++i) {
        const Fitted& fitted = model.fitted[i];
        auto outcome = solve(model, i, collection, needs.of[i], std::nullopt);
        if (const auto* refusal = std::get_if<Refusal>(&outcome)) {
            sink.report(refusal->code, fitted.span,
                        fmt::format("'{}' cannot be fitted: {}", fitted.name, refusal->message));
            return std::nullopt;
        }
        solutions.push_back(std::move(std::get<Solution>(outcome)));
        warn_of_constants(model, fitted, solutions.back(), sink);
        if (const auto target = check::fill(model, i, solutions.back().filling)) {
            sink.report(Code::fit_out_of_range, fitted.span,
                        fmt::format("'{}' takes a row of target '{}' beyond float32", fitted.name,
                                    model.targets[*target].name));
            return std::nullopt;
        }
    }
    return solutions;
}

/// Labels of a predicate in `where` that has a truth came from arrays in its place.
bool chosen_by_arrays(const check::Model& model, const Fitted& fitted,
                      const Collection& collection) {
    if (fitted.where == check::kNone) return false;
    const std::vector<Index> predicates = check::predicates_of(model, fitted.where);
    return std::any_of(model.truths.begin(), model.truths.end(), [&](const check::Truth& truth) {
        const auto among = [&](const std::vector<Index>& all) {
            return std::find(all.begin(), all.end(), truth.predicate) != all.end();
        };
        return among(predicates) && among(collection.from_arrays);
    });
}

fitted::Entry entry_of(const check::Model& model, const Fitted& fitted, const Solution& solution,
                       const Collection& collection) {
    check::FittedProvenance provenance = check::provenance(model, fitted);
    if (chosen_by_arrays(model, fitted, collection)) provenance.truth = "array";
    fitted::Entry entry;
    entry.name = fitted.name;
    entry.declaration = fitted.declaration;
    entry.of = std::move(provenance.of);
    entry.truth = std::move(provenance.truth);
    entry.rows = fitted.rows;
    entry.columns = fitted.columns;
    entry.matrix = solution.filling.matrix;
    entry.offset = solution.filling.offset;
    entry.hash = fitted::content_hash(entry);
    entry.frames = solution.counts.holds;
    for (const Source* source : solution.medoids)
        entry.medoids.push_back({collection.episodes[source->episode].hash, source->frame.step});
    return entry;
}

}  // namespace

std::optional<Fit> fit(const check::Model& model, const Request& request, diag::Sink& sink) {
    if (model.fitted.empty()) {
        nothing_to_fit(model, sink);
        return std::nullopt;
    }
    const std::vector<std::string>& paths = request.episodes;
    // The sums of Eigen's products are in an order that depends on the sizes of caches.
    Eigen::setCpuCacheSizes(32 << 10, 512 << 10, 4 << 20);
    const auto labelled = episodes::labelled_in(model, paths.front(), request.names);
    if (!labelled) {
        sink.report(data::in_trace(labelled.failure(), paths.front()));
        return std::nullopt;
    }
    Needs needs = needs_of(model);
    const std::vector<Index> predicates = separating_predicates(model, *labelled);
    for (const Index predicate : predicates)
        if (const auto need = plain_need(model, predicate)) needs.add(*need);
    const auto collection = collect(model, needs.all, paths, request, sink);
    if (!collection) return std::nullopt;
    const auto recorded = episodes::recorded(collection->episodes);
    const thresholds::Allowance allowance =
        episodes::admit(model, recorded, {}, {}, request.allow_overlap, sink);
    if (sink.has_errors()) return std::nullopt;

    check::Model filled = model;
    const auto solutions = solve_all(filled, needs, *collection, sink);
    if (!solutions) return std::nullopt;
    const auto separations = separate(model, needs, *collection, predicates, request, sink);
    if (!separations) return std::nullopt;

    Fit result;
    result.file.spec = model.name;
    result.file.etlc = request.version;
    for (std::size_t i = 0; i < solutions->size(); ++i)
        result.file.entries[filled.fitted[i].name] =
            entry_of(filled, filled.fitted[i], (*solutions)[i], *collection);
    for (const episodes::Recorded& episode : collection->episodes) {
        result.file.episodes.push_back(episode.hash);
        result.file.recordings[episode.hash] = episode.content;
    }
    if (allowance.overlapping + allowance.leaked > 0) result.file.allowances.push_back(allowance);
    result.report = report(filled, *collection, *solutions, *separations);
    for (const thresholds::Allowance& used : result.file.allowances)
        result.report += fmt::format("\n{}\n", thresholds::text(used));
    result.report += episodes::remark_on(allowance);
    return result;
}

}  // namespace etlc::fit
