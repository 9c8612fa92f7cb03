#include "fit/fill.hpp"

#include <fmt/format.h>

#include <atomic>
#include <exception>

#include "episodes/parallel.hpp"

namespace etlc::fit {

namespace {

/// The first projection of the point that is refused.
const Refusal* refusal_of(const check::Model& model, Index point,
                          const std::map<Index, Refusal>& refusals) {
    for (; model.points[point].is_projected(); point = model.points[point].inner) {
        const auto found = refusals.find(model.projections[model.points[point].projection].fitted);
        if (found != refusals.end()) return &found->second;
    }
    return nullptr;
}

}  // namespace

Filled fill(const check::Model& model, Solver& solver, std::optional<std::size_t> left_out) {
    Filled result{model, std::vector<Solution>(model.fitted.size()), {}};
    for (Index i = 0; i < model.fitted.size(); ++i) {
        if (const Refusal* of_point = refusal_of(model, model.fitted[i].point, result.refusals)) {
            result.refusals[i] = *of_point;
            continue;
        }
        auto outcome = solver.solve(result.model, i, left_out);
        if (auto* refusal = std::get_if<Refusal>(&outcome)) {
            result.refusals[i] = std::move(*refusal);
            continue;
        }
        result.solutions[i] = std::move(std::get<Solution>(outcome));
        if (const auto target = check::fill(result.model, i, result.solutions[i].filling))
            result.refusals[i] = {diag::Code::fit_out_of_range,
                                  fmt::format("with it, a row of target '{}' is beyond float32",
                                              model.targets[*target].name)};
    }
    return result;
}

FilledAll fill_all(const check::Model& model, Solver& solver, bool all, bool without,
                   unsigned jobs) {
    const std::size_t folds = without ? solver.collection().folds.size() : 0;
    FilledAll result{{}, std::vector<Filled>(folds)};
    std::atomic<std::size_t> next = all ? 0 : 1;
    const std::exception_ptr failure = episodes::in_threads(jobs, folds + 1, [&] {
        for (std::size_t i = next++; i <= folds; i = next++)
            if (i == 0)
                result.all = fill(model, solver, std::nullopt);
            else
                result.without[i - 1] = fill(model, solver, i - 1);
    });
    if (failure) std::rethrow_exception(failure);
    return result;
}

}  // namespace etlc::fit
