#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "compile.hpp"
#include "data/files/file.hpp"
#include "driver/commands/commands.hpp"
#include "driver/commands/crossvalidate.hpp"
#include "driver/process/process.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"
#include "recordings/open.hpp"
#include "source/text.hpp"

namespace etlc::driver {

namespace {

/// A spec to be evaluated: compiled, or without thresholds where folds provide them.
struct Candidate {
    SpecToJudge spec;
    std::optional<Compiled> compiled;
    std::optional<check::Model> untrained;

    const check::Model& model() const { return compiled ? *compiled->model : *untrained; }
};

std::optional<Candidate> candidate(const SpecToJudge& spec, const Request& request, bool trains) {
    Candidate result{spec, {}, {}};
    check::Options options = trains ? without_results(request.check) : request.check;
    options.judged_lets = true;
    if (trains) {
        result.untrained =
            check::check(parse::parse(spec.file, spec.sink), spec.file, options, spec.sink);
    } else {
        result.compiled = compile(spec.file, options, request, spec.sink);
    }
    if (spec.sink.refused() || (!result.compiled && !result.untrained)) return std::nullopt;
    return result;
}

std::vector<std::string> inputs(const std::vector<Candidate>& candidates,
                                const std::vector<std::string>& episodes,
                                const episodes::ReadOptions& reading) {
    std::vector<std::string> paths;
    for (const Candidate& one : candidates) {
        const auto read = files_read(one.model(), one.spec.file, episodes, reading);
        paths.insert(paths.end(), read.begin(), read.end());
    }
    return paths;
}

std::optional<evaluate::SideBySide> judged(const std::vector<Candidate>& candidates,
                                           const Request& request, const evaluate::Request& asked) {
    std::optional<Folds> folds;  // all specs use those of the first
    evaluate::SideBySide result;
    std::optional<evaluate::Judgement> first;
    for (const Candidate& one : candidates) {
        const std::string& path = one.spec.file.path();
        diag::Sink found;  // also about episodes, with the spec in a note
        auto judgement =
            request.folds > 0
                ? judge_in_folds(one.spec.file, one.model(), request, asked, folds, found)
                : judge_as_it_is(*one.compiled, path, request, asked, found);
        std::optional<evaluate::Evaluation> summary;
        if (judgement) summary = evaluate::summarise(*judgement, asked.jobs);
        if (summary) evaluate::warn_of_doubts(one.model(), *summary, found);
        one.spec.sink.add(found, candidates.size() > 1 ? fmt::format("for the spec {}", path) : "");
        if (!summary) return std::nullopt;
        auto& spec = result.specs.emplace_back();
        spec.path = path;
        spec.evaluation = std::move(*summary);
        if (request.evaluate.by_episode)
            spec.evaluation.by_episode = evaluate::by_episode(*judgement);
        if (first)
            spec.differences = evaluate::differences(*first, *judgement);
        else
            first = std::move(judgement);
    }
    return result;
}

/// The table is printed before the files take their names: where that fails, nothing has changed.
bool write(const evaluate::SideBySide& specs, const Request& request, diag::Sink& sink) {
    const Request::Evaluate& asked = request.evaluate;
    OutputFiles files(sink);
    const bool prints = asked.json != kStandardOutput && asked.csv != kStandardOutput;
    const auto csv = [&] {
        return asked.by_episode ? evaluate::csv_by_episode(specs) : evaluate::csv(specs);
    };
    return (asked.json.empty() || files.add(asked.json, evaluate::json(specs))) &&
           (asked.csv.empty() || files.add(asked.csv, csv())) &&
           (!prints || files.add(std::string(kStandardOutput),
                                 source::visible_lines(evaluate::table(specs)))) &&
           files.commit();
}

}  // namespace

std::optional<thresholds::File> thresholds_of(const check::Model& model, const std::string& spec,
                                              const Request& request) {
    const std::string& given = request.check.thresholds_path;
    const std::string path = given.empty() ? check::default_thresholds_path(spec) : given;
    if (std::find(model.dependencies.begin(), model.dependencies.end(), path) ==
        model.dependencies.end())
        return std::nullopt;
    auto file = thresholds::read(path);
    if (!file) return std::nullopt;  // check/ has read it and reported errors
    return std::move(*file);
}

std::optional<evaluate::Judgement> judge_as_it_is(const Compiled& compiled, const std::string& spec,
                                                  const Request& request,
                                                  const evaluate::Request& asked,
                                                  diag::Sink& sink) {
    std::vector<std::size_t> all(asked.episodes.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return evaluate::judge({{compiled, thresholds_of(*compiled.model, spec, request),
                             std::move(all), fitted_file(*compiled.model, spec, request)}},
                           asked, sink);
}

bool evaluate(const std::vector<SpecToJudge>& specs, const Request& request) {
    std::vector<Candidate> candidates;
    std::vector<const check::Model*> models;
    for (const SpecToJudge& spec : specs) {
        auto next = candidate(spec, request, request.folds > 0);
        if (!next) return false;
        candidates.push_back(std::move(*next));
    }
    for (const Candidate& one : candidates) models.push_back(&one.model());
    diag::Sink& sink = specs[0].sink;
    auto shard = sharing_of(request);
    auto asked = asked_of<evaluate::Request>(request);
    asked.sharing = shard ? &*shard : request.merged;
    asked.allow_overlap = request.allow_overlap;
    asked.limits = request.limits;
    asked.variants = request.evaluate.variants;
    if (request.folds > 0) asked.reading.cache = std::make_shared<episodes::TraceCache>();
    if (!check_names(models, asked.reading.names, sink)) return false;
    asked.episodes = find_shared_episodes(asked.sharing, request.data, request.chosen, sink);
    if (sink.has_errors()) return false;
    if (!read_labels(models, request, asked.episodes, asked.reading, sink)) return false;
    const auto outputs = is_shard(asked.sharing) ? std::vector<std::string>{request.shard.part}
                                                 : std::vector<std::string>{request.evaluate.json,
                                                                            request.evaluate.csv};
    auto read = inputs(candidates, asked.episodes, asked.reading);
    const auto parts = merged_files(asked.sharing);
    read.insert(read.end(), parts.begin(), parts.end());
    if (!check_outputs(outputs, read, sink)) return false;
    if (!note_loaded(asked.sharing, inputs(candidates, {}, asked.reading), sink)) return false;
    const auto result = judged(candidates, request, asked);
    if (is_shard(asked.sharing)) return write_part(*asked.sharing, request.shard.part, sink);
    return result && write(*result, request, sink);
}

}  // namespace etlc::driver
