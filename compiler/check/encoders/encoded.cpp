#include "check/encoders/encoded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "check/context/context.hpp"
#include "check/encoders/encoders.hpp"
#include "check/guarantees/provenance.hpp"
#include "check/matrices/matrices.hpp"
#include "check/numbers/decimal.hpp"
#include "data/arrays/array.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "data/traces/trace.hpp"

namespace etlc::check {

namespace {

using diag::Code;

constexpr std::string_view kEmbedAgain = "embed again with 'etlc embed'";

std::optional<embedded::File> read_file(Context& c, const Encoder& first) {
    const std::string& given = c.options.embedded_path;
    const std::string path = given.empty() ? embedded::default_path(c.file.path()) : given;
    if (exists(path))
        return read_made(c, path, embedded::read, first.span,
                         fmt::format("'{}' makes embeddings", first.name));
    c.report_data({Code::embedded_missing,
                   fmt::format("'{}' makes embeddings, but there is no file {}", first.name, path),
                   first.span})
        .note("'etlc embed' makes it from the images in the spec; --embedded selects another file");
    return std::nullopt;
}

/// Returns the differences since the encoder was run. A missing model is no difference: it is not
/// needed to build a monitor.
std::vector<std::string> changes(Context& c, Encoder encoder, const embedded::Encoder& then) {
    std::vector<std::string> found;
    if (then.declaration != encoder.declaration)
        found.push_back(changed("the declaration", then.declaration, encoder.declaration));
    if (encoder.dimension != 0 && then.dimension != encoder.dimension)
        found.push_back(changed("the dimension", std::to_string(then.dimension),
                                std::to_string(encoder.dimension)));
    const std::string path = beside_spec(c, encoder.model);
    if (!found.empty() || !exists(path)) return found;
    c.dependencies.insert(path);
    if (exists(settings_path(path))) c.dependencies.insert(settings_path(path));
    if (!encoder.preprocessor.empty()) c.dependencies.insert(beside_spec(c, encoder.preprocessor));
    std::string place;
    const auto now = describe(encoder, c.file.path(), place);
    if (!now) {
        c.sink.report(data::in_file(now.failure(), place));
        return found;
    }
    if (now->model != then.model) found.push_back(fmt::format("{} has changed", encoder.model));
    if (now->settings != then.settings)
        found.push_back(changed("the settings", then.settings, now->settings));
    return found;
}

/// Returns nothing after an error.
std::optional<Encoded> encoded_of(Context& c, const ast::Target::Source& source,
                                  const std::optional<ast::Name>& encoder) {
    Encoded result;
    result.span = span_of(source);
    const auto* const images = std::get_if<ast::Images>(&source);
    if (!encoder) {
        c.report(Code::encoder_use, result.span,
                 fmt::format("{} need an encoder, since a target consists of embeddings",
                             images != nullptr ? "images" : "frames of a video"))
            .note(images != nullptr ? "for example: target T = images(\"bay/*.png\") by NAME;"
                                    : "for a recording with embeddings, name the input: "
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

/// Returns the differences since the images were embedded. If all files are missing there is no
/// difference: they are not needed to build a monitor.
std::vector<std::string> changes(Context& c, const Encoded& encoded, const embedded::Entry& entry) {
    const auto now = files_of(encoded, c.file.path());
    if (!now) return {};
    std::vector<std::string> found;
    std::set<std::string> then;
    for (const embedded::Source& source : entry.sources) then.insert(source.path);
    for (const std::string& path : *now)
        if (!then.contains(path)) found.push_back(fmt::format("{} is new", path));
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

/// Returns the index in Model::encoded, which has equal elements once.
Index add(Model& model, const Encoded& encoded) {
    const auto same = [&](const Encoded& other) { return other.text == encoded.text; };
    const auto at = std::find_if(model.encoded.begin(), model.encoded.end(), same);
    const auto index = static_cast<Index>(at - model.encoded.begin());
    if (at == model.encoded.end()) model.encoded.push_back(encoded);
    return index;
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

std::optional<Matrix> read_encoded(Context& c, const ast::Target::Source& source,
                                   const std::optional<ast::Name>& encoder) {
    const auto encoded = encoded_of(c, source, encoder);
    if (!encoded || !c.embedded_file) return std::nullopt;
    const std::string& path = c.embedded_file->path;
    const auto found = c.embedded_file->entries.find(encoded->text);
    if (found == c.embedded_file->entries.end()) {
        c.report_data({Code::embedded_missing,
                       fmt::format("{} has no entry for {}", path, encoded->text), encoded->span})
            .note("'etlc embed' makes it");
        return std::nullopt;
    }
    const embedded::Entry& entry = found->second;
    std::vector<std::string> differences = changes(c, *encoded, entry);
    constexpr std::size_t kMostShown = 5;
    if (differences.size() > kMostShown) {
        const std::string more = fmt::format("and {} more", differences.size() - kMostShown);
        differences.resize(kMostShown);
        differences.push_back(more);
    }
    const bool is_current =
        is_up_to_date(c, Code::embedded_stale, encoded->span,
                      fmt::format("{} has embeddings of other {} than the present ones", path,
                                  encoded->is_video ? "frames" : "images"),
                      differences, kEmbedAgain);
    if (!is_current) return std::nullopt;
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

void check_embeddings(Context& c) {
    if (c.model.encoders.empty()) return;
    c.embedded_file = read_file(c, c.model.encoders.front());
    if (!c.embedded_file) return;
    for (Encoder& encoder : c.model.encoders) {
        const auto found = c.embedded_file->encoders.find(encoder.name);
        if (found == c.embedded_file->encoders.end()) {
            c.report_data(
                 {Code::embedded_missing,
                  fmt::format("{} has no embeddings by '{}'", c.embedded_file->path, encoder.name),
                  encoder.span})
                .note(std::string(kEmbedAgain));
            continue;
        }
        encoder.fingerprint = embedded::fingerprint(found->second);
        encoder.references = found->second.references;
        encoder.otherwise = embedded::fingerprints_otherwise(found->second);
        is_up_to_date(c, Code::embedded_stale, encoder.span,
                      fmt::format("'{}' is not the encoder that made {}", encoder.name,
                                  c.embedded_file->path),
                      changes(c, encoder, found->second), kEmbedAgain);
    }
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

// Reads frames of a recording as rows: frames("ep.npz", "z", [120, 180]).

namespace {

/// Steps of a recording are numbered from 0 in 32 bits.
constexpr std::uint64_t kMaxFrame = kMaxBound;
/// Limit on the frames of one declaration.
constexpr std::uint64_t kMaxFrames = 1U << 20U;

std::optional<std::uint64_t> whole(Context& c, const ast::Number& number, std::uint64_t least) {
    const auto value = Decimal::parse(number.text).whole(kMaxFrame);
    if (value && *value >= least) return value;
    return c.no_value(
        Code::frames_form, number.span,
        fmt::format("{}; expected a whole number of at least {}", shown(number), least));
}

const Input* input_of(Context& c, const ast::Frames& written) {
    const ast::Name name{written.key, written.key_span};
    const Index index = resolve(c, name, NameKind::input);
    if (index == kNone) return nullptr;
    const Input& input = c.model.inputs[index];
    if (input.is_embedding()) return &input;
    c.report(Code::frames_form, written.key_span,
             fmt::format("'{}' is not an embedding, but the rows of a target are", written.key));
    return nullptr;
}

/// Converts a sample to float32, scaled if the input is i8; false, with an error, if it is missing.
bool take(Context& c, const ast::Frames& written, const Input& input, std::uint64_t frame,
          const data::Sample& sample, std::vector<float>& row) {
    row.clear();
    for (const double x : sample.values[0])
        row.push_back(static_cast<float>(
            input.type == InputType::i8 ? x * static_cast<double>(input.scale) : x));
    const bool finite =
        std::all_of(row.begin(), row.end(), [](float x) { return std::isfinite(x); });
    if (sample.present[0] && finite) return true;
    return c.refuse(Code::no_such_frame, written.span,
                    fmt::format("{}: '{}' is missing or not finite at step {}", written.path,
                                written.key, frame));
}

void report(Context& c, const ast::Frames& written, const std::string& path,
            const diag::Failure& failure) {
    diag::Diagnostic diagnostic = data::in_file(failure, path);
    diagnostic.span = written.span;
    c.report_data(std::move(diagnostic), !exists(data::trace_file(path)));
}

}  // namespace

std::optional<std::vector<std::uint64_t>> frames_of(Context& c, const ast::Frames& written) {
    std::vector<std::uint64_t> listed;
    for (const ast::Number& number : written.frames) {
        const auto frame = whole(c, number, 0);
        if (!frame) return std::nullopt;
        listed.push_back(*frame);
    }
    if (!written.stride) return listed;
    const auto stride = whole(c, *written.stride, 1);
    if (!stride) return std::nullopt;
    if (listed.size() != 2 || listed[0] > listed[1])
        return c.no_value(Code::frames_form, written.frames_span,
                          "with a stride, expected the first and the last frame: [10, 50]");
    if ((listed[1] - listed[0]) / *stride >= kMaxFrames)
        return c.no_value(Code::frames_form, written.frames_span,
                          fmt::format("more than {} frames", kMaxFrames));
    std::vector<std::uint64_t> frames;
    for (std::uint64_t frame = listed[0]; frame <= listed[1]; frame += *stride)
        frames.push_back(frame);
    return frames;
}

/// Opens a recording, where the caller has readers.
diag::Result<std::unique_ptr<data::Trace>> open_recording(const Context& c, const Input& input,
                                                          const std::string& path) {
    if (c.options.open_trace == nullptr)
        return diag::Failure{Code::unknown_trace_format, "recordings are not read here"};
    return c.options.open_trace(path, {{input.name, data::Channel::Kind::vector, input.dimension}});
}

std::optional<Matrix> read_frames(Context& c, const ast::Frames& written) {
    const Input* const input = input_of(c, written);
    const auto frames = frames_of(c, written);
    if (input == nullptr || !frames) return std::nullopt;
    const std::string path = beside_spec(c, written.path);
    c.dependencies.insert(data::trace_file(path));
    const auto trace = open_recording(c, *input, path);
    if (!trace) return report(c, written, path, trace.failure()), std::nullopt;
    if (input->encoder != kNone) {
        const auto marks = embedded::read_marks(path);
        if (!marks) return report(c, written, path, marks.failure()), std::nullopt;
        if (const auto other = other_encoder(c.model, *input, input->name, *marks))
            return report(c, written, path, *other), std::nullopt;
        if (is_unmarked(*input, input->name, *marks))
            explain_unmarked(c.report(
                Code::unmarked_episode, written.span,
                fmt::format("{} does not say which encoder made '{}'", written.path, input->name)));
    }

    Matrix matrix;
    matrix.rows = static_cast<std::uint32_t>(frames->size());
    matrix.columns = input->dimension;
    matrix.values.resize(std::size_t{matrix.rows} * matrix.columns);
    std::multimap<std::uint64_t, std::size_t> rows_of;  // by step
    for (std::size_t i = 0; i < frames->size(); ++i) rows_of.emplace((*frames)[i], i);
    const std::uint64_t last = rows_of.rbegin()->first;
    data::Sample sample;
    std::vector<float> row;
    for (std::uint64_t step = 0; step <= last; ++step) {
        const auto more = (*trace)->next(sample);
        if (!more) return report(c, written, path, more.failure()), std::nullopt;
        if (!*more)
            return c.no_value(Code::no_such_frame, written.frames_span,
                              fmt::format("{} has {}; there is no step {} (from 0)", written.path,
                                          diag::counted(step, "step"), last));
        const auto [first, end] = rows_of.equal_range(step);
        for (auto at = first; at != end; ++at) {
            if (!take(c, written, *input, step, sample, row)) return std::nullopt;
            std::copy(
                row.begin(), row.end(),
                matrix.values.begin() + static_cast<std::ptrdiff_t>(at->second * matrix.columns));
        }
    }
    matrix.origin = fmt::format("{}:{}", written.path, written.key);
    matrix.path = path;
    matrix.hash = data::content_hash({matrix.rows, matrix.columns}, matrix.values);
    return matrix;
}

}  // namespace etlc::check
