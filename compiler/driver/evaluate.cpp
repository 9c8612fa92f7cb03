#include "driver/evaluate.hpp"

#include <algorithm>

#include "data/files/file.hpp"
#include "data/traces/episodes.hpp"
#include "data/traces/trace.hpp"
#include "driver/options/names.hpp"
#include "driver/output_file.hpp"
#include "driver/progress.hpp"
#include "source/escape.hpp"

namespace etlc::driver {

namespace {

/// The file that the spec's thresholds were read from; nothing where nothing is calibrated.
std::optional<thresholds::File> thresholds_of(const check::Model& model, const std::string& spec,
                                              const Request& request) {
    const std::string& given = request.check.thresholds_path;
    const std::string path = given.empty() ? check::default_thresholds_path(spec) : given;
    if (std::find(model.dependencies.begin(), model.dependencies.end(), path) ==
        model.dependencies.end())
        return std::nullopt;
    auto file = thresholds::read(path);
    if (!file) return std::nullopt;  // check/ has read it, and would have said so
    return std::move(*file);
}

std::vector<std::string> inputs(const check::Model& model, const source::File& file,
                                const std::vector<std::string>& episodes) {
    std::vector<std::string> paths = model.dependencies;
    paths.push_back(file.path());
    for (const std::string& episode : episodes) paths.push_back(data::trace_file(episode));
    return paths;
}

}  // namespace

bool evaluate(const source::File& file, const Request& request, const EvaluateRequest& evaluation,
              diag::Sink& sink) {
    const auto compiled = compile(file, request, sink);
    if (!compiled || sink.refused()) return false;
    const check::Model& model = *compiled->model;
    evaluate::Request asked = evaluation.evaluation;
    if (!check_names(model, asked.names, sink)) return false;
    asked.episodes = data::find_episodes(evaluation.data, evaluation.groups, sink);
    if (sink.has_errors()) return false;
    if (!check_outputs({evaluation.json, evaluation.csv}, inputs(model, file, asked.episodes),
                       sink))
        return false;
    asked.progress = episodes_progress();

    asked.limits = request.limits;
    const auto result =
        evaluate::evaluate(*compiled, asked, thresholds_of(model, file.path(), request), sink);
    if (!result) return false;
    // What is printed comes before the files take their names: where a part of it is lost, nothing
    // has changed.
    OutputFiles files(sink);
    const bool prints = evaluation.json != kStandardOutput && evaluation.csv != kStandardOutput;
    return (evaluation.json.empty() || files.add(evaluation.json, evaluate::json(*result))) &&
           (evaluation.csv.empty() || files.add(evaluation.csv, evaluate::csv(*result))) &&
           (!prints || files.add(std::string(kStandardOutput),
                                 source::visible_lines(evaluate::table(*result)))) &&
           files.commit();
}

}  // namespace etlc::driver
