#include "check/encoders/encoded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "check/context/steps.hpp"
#include "check/encoders/frames.hpp"
#include "check/matrices/matrices.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "data/frames/frames.hpp"

namespace etlc::check {

namespace {

using diag::Code;

Span span_of(const ast::Target::Source& source) {
    return std::visit([](const auto& s) { return s.span; }, source);
}

/// Nothing where it had an error, which is reported.
std::optional<Encoded> encoded_of(Context& c, const ast::Target::Source& source,
                                  const std::optional<ast::Name>& encoder) {
    Encoded result;
    result.span = span_of(source);
    const auto* const images = std::get_if<ast::Images>(&source);
    if (!encoder) {
        c.report(Code::encoder_use, result.span,
                 fmt::format("{} by which encoder? A target holds embeddings",
                             images != nullptr ? "images" : "frames of a video"))
            .note(images != nullptr ? "for example: target T = images(\"bay/*.png\") by NAME;"
                                    : "of a recording with embeddings, name the input: "
                                      "frames(\"FILE\", \"z\", [120])");
        return std::nullopt;
    }
    result.encoder = resolve(c, *encoder, NameKind::encoder);
    if (images == nullptr) {
        const auto& video = std::get<ast::Frames>(source);
        const auto frames = frames_of(c, video);
        if (!frames) return std::nullopt;
        result.is_video = true;
        result.path = video.path;
        result.frames = *frames;
    } else {
        result.path = images->path;
    }
    if (result.encoder == kNone) return std::nullopt;
    result.text = fmt::format(
        "{} by {}",
        images != nullptr ? ast::print(*images) : ast::print(std::get<ast::Frames>(source)),
        encoder->text);
    return result;
}

std::vector<std::string> paths_in(const embedded::Entry& entry) {
    std::vector<std::string> paths;
    for (const embedded::Source& source : entry.sources) paths.push_back(source.path);
    return paths;
}

/// What is not as it was, a sentence each. Files that are gone, all of them, are not missed: where
/// a monitor is built there need be no images.
std::vector<std::string> changes(Context& c, const Encoded& encoded, const embedded::Entry& entry) {
    const auto now = files_of(encoded, c.file.path());
    if (!now) return {};
    std::vector<std::string> found;
    const std::vector<std::string> then = paths_in(entry);
    for (const std::string& path : *now)
        if (std::find(then.begin(), then.end(), path) == then.end())
            found.push_back(fmt::format("{} is new", path));
    for (const embedded::Source& source : entry.sources) {
        if (std::find(now->begin(), now->end(), source.path) == now->end()) {
            found.push_back(fmt::format("{} is gone", source.path));
            continue;
        }
        const std::string path = beside_spec(c, source.path);
        c.dependencies.insert(path);
        const auto hash = data::hash_of_file(path, Code::unreadable_image);
        if (!hash || *hash != source.hash)
            found.push_back(fmt::format("{} has changed", source.path));
    }
    return found;
}

}  // namespace

bool is_encoded(const ast::Target::Source& source) {
    const auto* const frames = std::get_if<ast::Frames>(&source);
    return std::holds_alternative<ast::Images>(source) ||
           (frames != nullptr && frames->key.empty());
}

diag::Result<std::vector<std::string>> files_of(const Encoded& encoded,
                                                const std::string& spec_path) {
    const std::string folder = std::filesystem::path(spec_path).parent_path().string();
    if (!encoded.is_video) return data::find_images(folder, encoded.path);
    const std::string path = (std::filesystem::path(folder) / encoded.path).string();
    if (auto why = data::why_unreadable(path)) return diag::Failure{Code::unreadable_video, *why};
    return std::vector<std::string>{encoded.path};
}

namespace {

/// Of Model::encoded, where equal ones stand once.
Index add(Model& model, const Encoded& encoded) {
    const auto same = [&](const Encoded& other) { return other.text == encoded.text; };
    const auto at = std::find_if(model.encoded.begin(), model.encoded.end(), same);
    const auto index = static_cast<Index>(at - model.encoded.begin());
    if (at == model.encoded.end()) model.encoded.push_back(encoded);
    return index;
}

}  // namespace

std::optional<Matrix> read_encoded(Context& c, const ast::Target::Source& source,
                                   const std::optional<ast::Name>& encoder) {
    const auto encoded = encoded_of(c, source, encoder);
    if (!encoded || !c.embedded_file) return std::nullopt;
    const std::string& path = c.embedded_file->path;
    const auto found = c.embedded_file->entries.find(encoded->text);
    if (found == c.embedded_file->entries.end()) {
        diag::Diagnostic missing{Code::embedded_missing,
                                 fmt::format("{} has nothing for {}", path, encoded->text),
                                 encoded->span,
                                 {},
                                 0,
                                 0,
                                 {}};
        missing.is_allowed = c.options.allow_missing;
        c.lacks_data = c.lacks_data || missing.is_allowed;
        c.sink.report(std::move(missing)).note("'etlc embed' makes it");
        return std::nullopt;
    }
    const embedded::Entry& entry = found->second;
    if (const auto differences = changes(c, *encoded, entry); !differences.empty()) {
        constexpr std::size_t kMostTold = 5;
        auto& error = c.report(Code::embedded_stale, encoded->span,
                               fmt::format("{} holds embeddings of other {} than there are now",
                                           path, encoded->is_video ? "frames" : "images"));
        for (std::size_t i = 0; i < std::min(differences.size(), kMostTold); ++i)
            error.note(differences[i]);
        if (differences.size() > kMostTold)
            error.note(fmt::format("and {} more", differences.size() - kMostTold));
        error.note("embed again with 'etlc embed'");
        return std::nullopt;
    }
    Matrix matrix;
    matrix.rows = entry.rows;
    matrix.columns = entry.columns;
    matrix.values = entry.matrix;
    matrix.origin = encoded->text;
    matrix.path = path;
    matrix.hash = entry.hash;
    matrix.encoded = {{add(c.model, *encoded), 0, entry.rows}};
    return matrix;
}

void collect_encoded(Context& c) {
    for_each_declaration<ast::Target>(c.spec, [&](const ast::Target& declaration, Index) {
        for (const ast::Target::Source& source : declaration.sources) {
            if (!is_encoded(source)) continue;
            if (const auto encoded = encoded_of(c, source, declaration.encoder))
                add(c.model, *encoded);
        }
    });
}

}  // namespace etlc::check
