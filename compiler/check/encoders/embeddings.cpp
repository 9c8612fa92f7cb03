// Which encoders the embeddings are by, from the file that `etlc embed` wrote.
#include <fmt/format.h>

#include <filesystem>

#include "check/context/steps.hpp"
#include "check/encoders/settings.hpp"
#include "check/matrices/matrices.hpp"
#include "data/files/file.hpp"

namespace etlc::check {

namespace {

using diag::Code;

constexpr std::string_view kAgain = "embed again with 'etlc embed'";

bool exists(const std::string& path) {
    std::error_code unknown;
    return std::filesystem::exists(path, unknown) || unknown;
}

diag::Diagnostic& report_missing(Context& c, Span span, std::string message) {
    diag::Diagnostic found{Code::embedded_missing, std::move(message), span, {}, 0, 0, {}};
    found.is_allowed = c.options.allow_missing;
    c.lacks_data = c.lacks_data || found.is_allowed;
    return c.sink.report(std::move(found));
}

std::optional<embedded::File> read_file(Context& c, const Encoder& first) {
    const std::string& given = c.options.embedded_path;
    const std::string path = given.empty() ? embedded::default_path(c.file.path()) : given;
    if (!exists(path)) {
        report_missing(
            c, first.span,
            fmt::format("'{}' makes embeddings, and there is no file {}", first.name, path))
            .note(
                "'etlc embed' makes it, of the images that the spec names; --embedded names "
                "another");
        return std::nullopt;
    }
    auto file = embedded::read(path);
    if (!file) {
        c.sink.report(data::in_file(file.failure(), path))
            .note(first.span, fmt::format("'{}' makes embeddings", first.name));
        return std::nullopt;
    }
    c.dependencies.insert(path);
    return std::move(*file);
}

std::string difference(std::string_view what, const std::string& then, const std::string& now) {
    return fmt::format("{} then: {}; now: {}", what, then, now);
}

/// What is not as it was. A model that is not here is not missed: where a monitor is built there
/// need be none.
std::vector<std::string> changes(Context& c, Encoder encoder, const embedded::Encoder& then) {
    std::vector<std::string> found;
    if (then.declaration != encoder.declaration)
        found.push_back(difference("the declaration", then.declaration, encoder.declaration));
    if (encoder.dimension != 0 && then.dimension != encoder.dimension)
        found.push_back(difference("the dimension", std::to_string(then.dimension),
                                   std::to_string(encoder.dimension)));
    if (then.kind != embedded::kCommand && !then.kind.starts_with(embedded::kOnnxRuntime))
        found.emplace_back(
            "an earlier etlc ran it, by OpenCV, whose numbers may be others than the model's, or "
            "by "
            "ONNX Runtime without its version");
    const std::string path = beside_spec(c, encoder.model);
    if (!found.empty() || !exists(path)) return found;
    c.dependencies.insert(path);
    if (exists(settings_path(path))) c.dependencies.insert(settings_path(path));
    std::string place;
    const auto now = describe(encoder, path, place);
    if (!now) {
        c.sink.report(data::in_file(now.failure(), place));
        return found;
    }
    if (now->model != then.model) found.push_back(fmt::format("{} has changed", encoder.model));
    if (now->settings != then.settings)
        found.push_back(difference("the settings", then.settings, now->settings));
    return found;
}

}  // namespace

void check_embeddings(Context& c) {
    if (c.model.encoders.empty()) return;
    c.embedded_file = read_file(c, c.model.encoders.front());
    if (!c.embedded_file) return;
    for (Encoder& encoder : c.model.encoders) {
        const auto found = c.embedded_file->encoders.find(encoder.name);
        if (found == c.embedded_file->encoders.end()) {
            report_missing(
                c, encoder.span,
                fmt::format("{} has nothing by '{}'", c.embedded_file->path, encoder.name))
                .note(std::string(kAgain));
            continue;
        }
        encoder.fingerprint = embedded::fingerprint(found->second);
        encoder.otherwise = embedded::fingerprints_otherwise(found->second);
        const auto differences = changes(c, encoder, found->second);
        if (differences.empty()) continue;
        auto& error = c.report(Code::embedded_stale, encoder.span,
                               fmt::format("'{}' is not the encoder that made {}", encoder.name,
                                           c.embedded_file->path));
        for (const std::string& one : differences) error.note(one);
        error.note(std::string(kAgain));
    }
}

}  // namespace etlc::check
