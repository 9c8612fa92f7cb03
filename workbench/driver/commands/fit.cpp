#include "fit/fit.hpp"
#include "driver/commands/commands.hpp"
#include "driver/commands/suggest_in_time.hpp"
#include "driver/process/output_file.hpp"
#include "driver/process/process.hpp"
#include "fit/suggest/suggest.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"
#include "recordings/episodes.hpp"
#include "recordings/open.hpp"
#include "source/text.hpp"

namespace etlc::driver {

namespace {

/// Checks another text of the spec; nothing where it has errors.
std::optional<check::Model> check_text(const source::File& file, const check::Options& options,
                                       const std::string& text) {
    diag::Sink sink;
    const source::File other(file.path(), text);
    ast::Spec spec = parse::parse(other, sink);
    auto model = check::check(std::move(spec), other, options, sink);
    return sink.has_errors() ? std::nullopt : std::move(model);
}

bool suggest(const source::File& file, const check::Model& model, const check::Options& options,
             const Request& request, const fit::Request& asked, diag::Sink& sink) {
    auto result = fit::suggest(
        model, [&](const std::string& text) { return check_text(file, options, text); },
        request.fit.predicates, asked, sink);
    if (!result || sink.refused()) return false;
    result->in_time = suggest_in_time(file, model, *result, request, asked);
    OutputFiles files(sink);
    return files.add(std::string(kStandardOutput),
                     request.fit.json ? fit::json(*result)
                                      : source::visible_lines(fit::report(*result))) &&
           files.commit();
}

}  // namespace

bool fit(const source::File& file, const Request& request, diag::Sink& sink) {
    ast::Spec spec = parse::parse(file, sink);
    check::Options options = request.check;
    options.allow_uncalibrated = true;
    options.allow_uncalibrated_monitors = true;
    options.allow_unfitted = true;
    const auto model = check::check(std::move(spec), file, options, sink);
    if (!model || sink.refused()) return false;

    auto asked = asked_of<fit::Request>(request);
    asked.allow_overlap = request.allow_overlap;
    if (!check_names({&*model}, asked.reading.names, sink)) return false;
    asked.version = library::kVersion;
    const std::string output =
        request.output.empty() ? fitted::default_path(file.path()) : request.output;
    asked.episodes = recordings::find_episodes(request.data, request.groups, sink);
    if (sink.has_errors()) return false;
    if (!read_labels({&*model}, request, asked.episodes, asked.reading, sink)) return false;
    if (request.fit.suggest) return suggest(file, *model, options, request, asked, sink);
    if (!check_outputs({output}, files_read(*model, file, asked.episodes, asked.reading), sink))
        return false;
    const auto result = fit::fit(*model, asked, sink);
    if (!result || sink.refused()) return false;

    // The report is written before the file takes its name: where that fails, nothing has changed.
    OutputFiles files(sink);
    return files.add(output, fitted::write(result->file)) &&
           files.add(output == kStandardOutput ? "/dev/stderr" : std::string(kStandardOutput),
                     source::visible_lines(result->report)) &&
           files.commit();
}

fitted::File fitted_file(const check::Model& model, const std::string& spec,
                         const Request& request) {
    if (model.fitted.empty()) return {};
    const std::string& given = request.check.fitted_path;
    const auto file = fitted::read(given.empty() ? fitted::default_path(spec) : given);
    return file ? *file : fitted::File{};  // check/ has read it and reported errors
}

}  // namespace etlc::driver
