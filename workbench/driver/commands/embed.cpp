#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>

#include "artifacts/embedded.hpp"
#include "check/check.hpp"
#include "check/encoders/encoders.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "embed/embed.hpp"
#include "embed/encoder.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"
#include "recordings/frames/frames.hpp"
#include "recordings/open.hpp"
#include "source/text.hpp"

namespace etlc::driver {

namespace {

namespace fs = std::filesystem;
using check::kNone;
using diag::Code;

bool has_encoded_input(const check::Model& model) {
    return std::any_of(model.inputs.begin(), model.inputs.end(),
                       [](const check::Input& input) { return input.encoder != kNone; });
}

/// Reports a spec without encoders where there are no recordings either.
bool has_work(const check::Model& model, bool with_recordings, diag::Sink& sink) {
    if (!model.encoders.empty() || with_recordings) return true;
    const source::Span place = model.file.text().empty() ? source::Span{} : source::Span{0, 1};
    sink.report(Code::nothing_to_embed, place, "the spec declares no encoder")
        .note(
            "add a line such as 'encoder dino = load(\"dino.onnx\"), image [224, 224];', and "
            "'by dino' behind an input and behind targets of images");
    return false;
}

/// Reports recordings of which the spec uses nothing.
bool has_inputs(const check::Model& model, const std::vector<embed::Recording>& recordings,
                diag::Sink& sink) {
    const bool have_columns =
        std::none_of(recordings.begin(), recordings.end(),
                     [](const embed::Recording& recording) { return recording.columns.empty(); });
    if (recordings.empty() || has_encoded_input(model) || (have_columns && !model.inputs.empty()))
        return true;
    const source::Span place = model.file.text().empty() ? source::Span{} : source::Span{0, 1};
    const bool has_encoder = !model.encoders.empty();
    sink.report(Code::nothing_to_embed, has_encoder ? model.encoders[0].span : place,
                "no input is made by an encoder, so recordings yield nothing")
        .note(fmt::format("declare what makes an input: input z : f32[D] by {};",
                          has_encoder ? model.encoders[0].name : "ENCODER"));
    return false;
}

/// Reports names of --map and --camera that are not inputs.
bool check_inputs(const check::Model& model, const Request& request, diag::Sink& sink) {
    recordings::NamesInFile of_inputs;  // without labels, which embedding ignores
    for (const auto& [name, in_file] : request.names)
        if (!name.starts_with("truth.")) of_inputs.emplace(name, in_file);
    if (!check_names({&model}, of_inputs, sink)) return false;
    for (const auto& [input, camera] : request.embed.cameras) {
        const auto made = [&, name = input](const check::Input& known) {
            return known.name == name && known.encoder != kNone;
        };
        if (input.empty() || std::any_of(model.inputs.begin(), model.inputs.end(), made)) continue;
        sink.report(data::in_file(
            {Code::no_such_camera, fmt::format("no input '{}' is by an encoder", input)},
            fmt::format("--camera {}={}", input, camera)));
        return false;
    }
    return true;
}

embed::Search search_of(const check::Model& model, const Request& request) {
    embed::Search search{request.data, request.chosen.groups, 0, request.embed.cameras, {}};
    if (model.step_seconds > 0) search.rate = 1 / model.step_seconds;
    for (const check::Input& input : model.inputs)
        if (input.encoder != kNone) search.inputs.push_back(input.name);
    return search;
}

/// The line on the terminal that says how far a call is; it is erased with this object.
class ProgressLine {
public:
    ProgressLine() = default;
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    ~ProgressLine() {
        if (width_ > 0) print_error(fmt::format("\r{:{}}\r", "", width_));
    }

    void show(const embed::Progress& now) {
        using namespace std::chrono;
        constexpr auto kPause = milliseconds(100);  // faster than anybody reads
        const auto time = steady_clock::now();
        if (width_ > 0 && time < shown_ + kPause) return;
        shown_ = time;
        std::string text = fmt::format("{} of {}, {}", now.done, diag::counted(now.of, "episode"),
                                       diag::counted(now.frames, "frame"));
        const double seconds = duration<double>(time - begin_).count();
        if (now.encoded > 0)
            text += fmt::format(", {:.0f} s left", seconds / static_cast<double>(now.encoded) *
                                                       static_cast<double>(now.of - now.done));
        print_error(fmt::format("\r{:{}}", text, width_));
        width_ = std::max(width_, text.size());
    }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point shown_;
    std::size_t width_ = 0;  ///< of the longest text so far
};

std::optional<embed::Progress> make_episodes(const check::Model& model, const embedded::File& file,
                                             const std::vector<embed::Recording>& recordings,
                                             embed::Request& asked, diag::Sink& sink) {
    ProgressLine line;
    if (progress_is_seen())
        asked.progress = [&](const embed::Progress& progress) { line.show(progress); };
    return embed::embed_recordings(model, file, recordings, asked, sink);
}

std::vector<std::string> reference_paths(const std::string& folder) {
    std::vector<std::string> paths;
    for (std::uint32_t i = 0; i < embedded::kReferenceFrames && !folder.empty(); ++i)
        paths.push_back((fs::path(folder) / fmt::format("reference-{}.png", i)).string());
    return paths;
}

bool write_references(const std::vector<std::string>& paths, OutputFiles& files, diag::Sink& sink) {
    for (std::uint32_t i = 0; i < paths.size(); ++i) {
        const auto png = recordings::png_of(recordings::reference_frame(i));
        if (!png) {
            sink.report(data::in_file(png.failure(), paths[i]));
            return false;
        }
        if (!files.add(paths[i], *png)) return false;
    }
    return true;
}

/// Assigns a recording to a shard by the content of its first and last file, so that neither names
/// nor the order matter; one of many recordings in a file is assigned by its name.
std::uint32_t shard_of(const embed::Recording& recording, std::uint32_t shards) {
    const auto& files = recording.files;
    const std::string content =
        files.empty() ? recording.episode
                      : fmt::format("{} {}{}", files.size(), data::ends_of_file(files.front()),
                                    data::ends_of_file(files.back()));
    return static_cast<std::uint32_t>(data::xxh64(content) % shards) + 1;
}

/// Says where an encoder gives all reference frames, which have nothing in common, one embedding.
std::string constant(const embedded::Encoder& encoder) {
    const std::vector<float>& rows = encoder.references;
    if (rows.empty() || !std::equal(rows.begin() + encoder.dimension, rows.end(), rows.begin()))
        return "";
    const bool is_zero = std::all_of(rows.begin(), rows.end(), [](float x) { return x == 0; });
    return fmt::format(
        "  it gives {} for {} different pictures: its weights may be missing, or "
        "image, mean and deviation not those of its training\n",
        is_zero ? "only zeros" : "one and the same embedding", embedded::kReferenceFrames);
}

std::string report(const check::Model& model, const embedded::File& file,
                   const std::vector<embed::Recording>& recordings, const std::string& folder,
                   const embed::Progress& made) {
    std::string text;
    for (const auto& [name, encoder] : file.encoders) {
        text += fmt::format("encoder {}: dimension {}, {} {}\n", name, encoder.dimension,
                            encoder.kind, embedded::fingerprint(encoder));
        text += constant(encoder);
    }
    for (const check::Encoded& encoded : model.encoded)
        if (const auto entry = file.entries.find(encoded.text); entry != file.entries.end())
            text += fmt::format("{}: {}\n", encoded.text, diag::counted(entry->second.rows, "row"));
    std::map<std::string, std::uint64_t> tasks;
    for (const embed::Recording& recording : recordings)
        for (const std::string& task : recording.tasks) ++tasks[task];
    for (const auto& [task, episodes] : tasks)
        text += fmt::format("task '{}': {}\n", task, diag::counted(episodes, "episode"));
    if (recordings.empty()) return text;
    text += fmt::format("{} in {}", diag::counted(recordings.size(), "episode"), folder);
    if (made.encoded < made.done)
        text += fmt::format(", {} with embeddings of an earlier call", made.done - made.encoded);
    return text + "\n";
}

/// `etlc embed --pipe ENCODER`, the encoder of a spec for other programs, as the Python package:
/// becomes the encoder, unless the embeddings of the spec are another's. Returns where that fails.
bool pipe_frames(const source::File& file, const Request& request, diag::Sink& sink) {
    // This reads the embeddings of the spec, and refuses those of another model or settings.
    auto model = check::check(parse::parse(file, sink), file, without_results(request.check), sink);
    if (!model || sink.refused()) return false;

    const std::string& name = request.embed.pipe;
    const auto fail = [&](const diag::Failure& failure) {
        sink.report(data::in_file(failure, fmt::format("--pipe {}", name)));
        return false;
    };
    const auto wanted = std::find_if(model->encoders.begin(), model->encoders.end(),
                                     [&](const auto& encoder) { return encoder.name == name; });
    if (wanted == model->encoders.end())
        return fail({Code::nothing_to_embed, fmt::format("the spec has no encoder '{}'", name)});

    const check::Encoder embedded = *wanted;
    embed::Request asked{request.embed.running, library::kVersion, {}, {}, {}};
    if (!embed::describe_encoders(*model, asked, sink)) return false;
    if (wanted->fingerprint != embedded.fingerprint) {
        const auto same_model = embedded.otherwise.find(wanted->fingerprint);
        return fail({Code::other_encoder,
                     fmt::format("'{}' is encoder {}{} here; expected {}, which made the "
                                 "embeddings of the spec",
                                 name, wanted->fingerprint,
                                 same_model == embedded.otherwise.end()
                                     ? ""
                                     : ", the same model run by " + same_model->second,
                                 embedded.fingerprint)});
    }
    return fail(embed::become(*wanted, data::beside(file.path(), wanted->model), asked.running));
}

}  // namespace

bool embed(const source::File& file, const Request& request, diag::Sink& sink) {
    if (!request.embed.pipe.empty()) return pipe_frames(file, request, sink);
    ast::Spec spec = parse::parse(file, sink);
    check::Options options = {.open_trace = request.check.open_trace};
    options.settings = request.check.settings;
    auto model = check::check_encoded(std::move(spec), file, options, sink);
    if (!model || !has_work(*model, !request.data.empty(), sink) || sink.refused()) return false;

    if (!check_inputs(*model, request, sink)) return false;
    auto recordings = embed::find_recordings(search_of(*model, request), sink);
    if (sink.refused() || !has_inputs(*model, recordings, sink)) return false;
    embed::Request asked{request.embed.running, library::kVersion, request.names, {}, {}};
    auto embeddings = embed::describe_encoders(*model, asked, sink);
    if (!embeddings) return false;
    const ShardRequest& shard = request.shard;
    if (shard.shards > 0)
        std::erase_if(recordings, [&](const embed::Recording& recording) {
            return shard_of(recording, shard.shards) != shard.shard;
        });

    const std::string& embedded_file = request.check.embedded_path;
    const std::string result =
        embedded_file.empty() ? embedded::default_path(file.path()) : embedded_file;
    const bool has_targets = !model->encoders.empty() && (shard.shards == 0 || shard.shard == 1);
    std::vector<std::string> outputs;
    if (has_targets) outputs.push_back(result);
    std::vector<std::string> inputs = {file.path()};
    for (const check::Encoder& encoder : model->encoders)
        inputs.push_back((fs::path(file.path()).parent_path() / encoder.model).string());
    for (const embed::Recording& recording : recordings) {
        outputs.push_back(embed::episode_path(request.output, recording));
        inputs.push_back(data::trace_file(recording.path));
        if (!recording.beside.empty()) inputs.push_back(recording.beside);
    }
    const std::vector<std::string> references = reference_paths(request.embed.references);
    outputs.insert(outputs.end(), references.begin(), references.end());
    if (!recordings.empty() && !make_folder(request.output, sink)) return false;
    if (!references.empty() && !make_folder(request.embed.references, sink)) return false;
    if (!check_outputs(outputs, inputs, sink)) return false;

    asked.folder = request.output;
    OutputFiles files(sink);
    if (has_targets && !embed::embed_targets(*model, asked, *embeddings, sink)) return false;
    if (!write_references(references, files, sink)) return false;
    const auto made = make_episodes(*model, *embeddings, recordings, asked, sink);
    return made && (!has_targets || files.add(result, embedded::write(*embeddings))) &&
           files.add(std::string(kStandardOutput),
                     source::visible_lines(
                         report(*model, *embeddings, recordings, request.output, *made))) &&
           files.commit();
}

}  // namespace etlc::driver
