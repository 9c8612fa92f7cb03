#include "driver/evaluate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "data/episodes.hpp"
#include "data/file.hpp"
#include "driver/names.hpp"
#include "driver/progress.hpp"

namespace etlc::driver {

namespace {

/// The file that the spec's thresholds were read from; nothing where nothing is calibrated.
std::optional<thresholds::File> thresholds_of(const check::Model& model, const std::string& spec,
                                              const Request& request) {
    const std::string& given = request.check.thresholds_path;
    const std::string path = given.empty() ? check::default_thresholds_path(spec) : given;
    if (std::find(model.dependencies.begin(), model.dependencies.end(), path) == model.dependencies.end())
        return std::nullopt;
    auto file = thresholds::read(path);
    if (!file) return std::nullopt;  // check/ has read it, and would have said so
    return std::move(*file);
}

bool write(const std::string& path, const std::string& text, diag::Sink& sink) {
    if (path.empty()) return true;
    const auto failure =
        data::write_file_atomically(path == "-" ? "/dev/stdout" : path, text, diag::Code::unwritable_output);
    if (failure) sink.report(data::in_file(*failure, path));
    return !failure;
}

}  // namespace

bool evaluate(const source::File& file, const Request& request, const EvaluateRequest& evaluation, diag::Sink& sink) {
    const auto compiled = compile(file, request, sink);
    if (!compiled || sink.refused()) return false;
    const check::Model& model = *compiled->model;
    evaluate::Request asked = evaluation.evaluation;
    if (!check_names(model, asked.names, sink)) return false;
    asked.episodes = data::find_episodes(evaluation.data, evaluation.groups, sink);
    if (sink.has_errors()) return false;
    asked.progress = episodes_progress();

    auto labelled = evaluate::find_labelled(model, asked, sink);
    if (!labelled) return false;
    evaluate::Subject subject = evaluate::subject(model, std::move(*labelled));
    const auto truth = compile(std::move(subject.truth.model), request.limits, sink);
    if (!truth) return false;
    const auto result = evaluate::evaluate(compiled->plan, truth->plan, subject, asked,
                                           thresholds_of(model, file.path(), request), sink);
    if (!result) return false;
    if (!write(evaluation.json, evaluate::json(*result), sink)) return false;
    if (!write(evaluation.csv, evaluate::csv(*result), sink)) return false;
    if (evaluation.json != "-" && evaluation.csv != "-") fmt::print("{}", evaluate::table(*result));
    return true;
}

}  // namespace etlc::driver
