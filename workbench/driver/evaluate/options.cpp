#include "driver/evaluate/options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "driver/fleet/options.hpp"
#include "driver/options/recording_options.hpp"

namespace etlc::driver {

void add_evaluate_options(CLI::App& app, EvaluateRequest& evaluation, bool crossvalidates) {
    constexpr std::uint32_t kUsualFolds = 5;
    add_episode_options(app, evaluation.data, evaluation.groups,
                        evaluation.evaluation.allow_overlap, evaluation.evaluation.jobs);
    add_map_option(app, evaluation.evaluation.names);
    if (crossvalidates) evaluation.folds = kUsualFolds;
    add_folds_option(app, evaluation.folds,
                     crossvalidates ? fmt::format("how many folds (default: {})", kUsualFolds)
                                    : "calibrate on N - 1 of N folds of the episodes and evaluate "
                                      "on the other, in turn, as etlc crossvalidate does");
    app.add_flag("--by-episode", evaluation.by_episode,
                 "also a row an episode, the worst first; the CSV then has these rows");
    app.add_option("--json", evaluation.json, "also write the result as JSON; - is standard output")
        ->type_name("FILE");
    app.add_option("--csv", evaluation.csv, "also write the result as CSV; - is standard output")
        ->type_name("FILE");
    if (!crossvalidates) add_shard_options(app, evaluation.shard);
}

std::string mistake_in_evaluate_call(const CLI::App& app, const std::vector<std::string>& specs,
                                     const EvaluateRequest& evaluation) {
    for (auto spec = specs.begin(); spec != specs.end(); ++spec)
        if (std::find(specs.begin(), spec, *spec) != spec)
            return fmt::format("the spec {} is given twice", *spec);
    if (evaluation.shard.shards > 0 && (specs.size() > 1 || evaluation.folds > 0))
        return "--shard goes with one spec, and not with folds";
    for (const char* option : {"--thresholds", "--fitted"}) {
        if (app.count(option) == 0) continue;
        if (evaluation.folds > 0)
            return fmt::format("{} does not go with folds, which learn theirs from the episodes",
                               option);
        if (specs.size() > 1)
            return fmt::format("{} goes with one spec; the files of several lie beside them",
                               option);
    }
    return mistake_in_shard_call(evaluation.shard);
}

}  // namespace etlc::driver
