#include "driver/learn/fit.hpp"

#include "data/recordings/episodes.hpp"
#include "data/recordings/open.hpp"
#include "driver/compile/names.hpp"
#include "driver/process/output_file.hpp"
#include "driver/process/progress.hpp"
#include "fit/fit.hpp"
#include "fit/suggest/suggest.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"
#include "source/escape.hpp"

namespace etlc::driver {

namespace {

/// Whatever a spec of this text declares; nothing where it is none.
std::optional<check::Model> check_text(const source::File& file, const check::Options& options,
                                       const std::string& text) {
    diag::Sink sink;
    const source::File other(file.path(), text);
    ast::Spec spec = parse::parse(other, sink);
    auto model = check::check(std::move(spec), other, options, sink);
    return sink.has_errors() ? std::nullopt : std::move(model);
}

bool suggest(const source::File& file, const check::Model& model, const check::Options& options,
             const FitRequest& request, const fit::Request& asked, diag::Sink& sink) {
    const auto result = fit::suggest(
        model, [&](const std::string& text) { return check_text(file, options, text); },
        request.predicates, asked, sink);
    if (!result || sink.refused()) return false;
    OutputFiles files(sink);
    return files.add(
               std::string(kStandardOutput),
               request.json ? fit::json(*result) : source::visible_lines(fit::report(*result))) &&
           files.commit();
}

}  // namespace

bool fit(const source::File& file, const FitRequest& request, diag::Sink& sink) {
    ast::Spec spec = parse::parse(file, sink);
    check::Options options;
    options.settings = request.settings;
    options.allow_uncalibrated = true;
    options.allow_uncalibrated_monitors = true;
    options.allow_unfitted = true;
    options.embedded_path = request.embedded;
    const auto model = check::check(std::move(spec), file, options, sink);
    if (!model || sink.refused()) return false;

    fit::Request asked = request.fit;
    if (!check_names({&*model}, asked.names, sink)) return false;
    asked.version = library::kVersion;
    asked.progress = episodes_progress();
    const std::string output =
        request.output.empty() ? fitted::default_path(file.path()) : request.output;
    asked.episodes = data::find_episodes(request.data, request.groups, sink);
    if (sink.has_errors()) return false;
    if (request.suggest) return suggest(file, *model, options, request, asked, sink);
    std::vector<std::string> inputs{file.path()};
    for (const std::string& episode : asked.episodes) inputs.push_back(data::trace_file(episode));
    inputs.insert(inputs.end(), model->dependencies.begin(), model->dependencies.end());
    if (!check_outputs({output}, inputs, sink)) return false;
    const auto result = fit::fit(*model, asked, sink);
    if (!result || sink.refused()) return false;

    // The report comes before the file takes its name: where a part of it is lost, nothing has
    // changed.
    OutputFiles files(sink);
    return files.add(output, fitted::write(result->file)) &&
           files.add(output == kStandardOutput ? "/dev/stderr" : std::string(kStandardOutput),
                     source::visible_lines(result->report)) &&
           files.commit();
}

fitted::File fitted_file(const check::Model& model, const std::string& spec,
                         const std::string& given) {
    if (model.fitted.empty()) return {};
    const auto file = fitted::read(given.empty() ? fitted::default_path(spec) : given);
    return file ? *file : fitted::File{};  // check/ has read it, and would have said so
}

}  // namespace etlc::driver
