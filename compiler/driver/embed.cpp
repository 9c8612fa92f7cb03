#include "driver/embed.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>

#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "driver/output_file.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"
#include "source/escape.hpp"

namespace etlc::driver {

namespace {

namespace fs = std::filesystem;
using check::kNone;
using diag::Code;

bool has_encoded_input(const check::Model& model) {
    return std::any_of(model.inputs.begin(), model.inputs.end(),
                       [](const check::Input& input) { return input.encoder != kNone; });
}

/// False, and reported, where the spec asks for no embedding.
bool has_work(const check::Model& model, bool with_recordings, diag::Sink& sink) {
    const source::Span place = model.file.text().empty() ? source::Span{} : source::Span{0, 1};
    if (model.encoders.empty()) {
        sink.report(Code::nothing_to_embed, place, "the spec declares no encoder")
            .note(
                "add a line such as 'encoder dino = load(\"dino.onnx\"), image [224, 224];', and "
                "'by dino' behind an input and behind targets of images");
        return false;
    }
    if (!with_recordings || has_encoded_input(model)) return true;
    sink.report(Code::nothing_to_embed, model.encoders[0].span,
                "no input is by an encoder, so recordings give nothing")
        .note(fmt::format("say of an input what makes it: input z : f32[D] by {};",
                          model.encoders[0].name));
    return false;
}

std::string episode_path(const std::string& folder, const embed::Recording& recording) {
    return (fs::path(folder) / (recording.episode + ".npz")).string();
}

/// All episodes take their names together, so their files are open until then.
void allow_many_files() {
    rlimit files{};
    if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return;
    files.rlim_cur = files.rlim_max;
    static_cast<void>(::setrlimit(RLIMIT_NOFILE, &files));
}

bool make_folder(const std::string& folder, diag::Sink& sink) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!error) return true;
    sink.report(data::in_file(
        {Code::unwritable_output, fmt::format("cannot be made: {}", error.message())}, folder));
    return false;
}

/// By the content of its first and last file, so that neither names nor the order count.
std::uint32_t shard_of(const embed::Recording& recording, std::uint32_t shards) {
    const auto& files = recording.files;
    const std::string content =
        files.empty() ? recording.episode
                      : fmt::format("{} {}{}", files.size(), data::ends_of_file(files.front()),
                                    data::ends_of_file(files.back()));
    return static_cast<std::uint32_t>(data::xxh64(content) % shards) + 1;
}

std::string report(const check::Model& model, const embedded::File& file, std::size_t episodes,
                   const std::string& folder) {
    std::string text;
    for (const auto& [name, encoder] : file.encoders)
        text += fmt::format("encoder {}: dimension {}, {} {}\n", name, encoder.dimension,
                            encoder.kind, embedded::fingerprint(encoder));
    for (const check::Encoded& encoded : model.encoded)
        if (const auto entry = file.entries.find(encoded.text); entry != file.entries.end())
            text += fmt::format("{}: {}\n", encoded.text, diag::counted(entry->second.rows, "row"));
    if (episodes > 0) text += fmt::format("{} in {}\n", diag::counted(episodes, "episode"), folder);
    return text;
}

}  // namespace

bool embed(const source::File& file, const EmbedRequest& request, diag::Sink& sink) {
    ast::Spec spec = parse::parse(file, sink);
    check::Options options;
    options.settings = request.settings;
    auto model = check::check_encoded(std::move(spec), file, options, sink);
    if (!model || !has_work(*model, !request.data.empty(), sink) || sink.refused()) return false;

    embed::Request asked = request.embed;
    asked.version = library::kVersion;
    auto embeddings = embed::describe_encoders(*model, asked, sink);
    if (!embeddings) return false;
    const double rate = model->step_seconds > 0 ? 1 / model->step_seconds : 0;
    auto recordings = embed::find_recordings(request.data, rate, sink);
    if (sink.has_errors()) return false;
    const ShardRequest& shard = request.shard;
    if (shard.shards > 0)
        std::erase_if(recordings, [&](const embed::Recording& recording) {
            return shard_of(recording, shard.shards) != shard.shard;
        });

    const std::string result =
        request.embedded.empty() ? embedded::default_path(file.path()) : request.embedded;
    const bool has_targets = shard.shards == 0 || shard.shard == 1;
    std::vector<std::string> outputs = {result};
    std::vector<std::string> inputs = {file.path()};
    for (const check::Encoder& encoder : model->encoders)
        inputs.push_back((fs::path(file.path()).parent_path() / encoder.model).string());
    for (const embed::Recording& recording : recordings) {
        outputs.push_back(episode_path(request.output, recording));
        inputs.push_back(recording.path);
        if (!recording.beside.empty()) inputs.push_back(recording.beside);
    }
    if (!recordings.empty() && !make_folder(request.output, sink)) return false;
    if (!check_outputs(outputs, inputs, sink)) return false;

    allow_many_files();
    OutputFiles files(sink);
    const auto keep = [&](const embed::Recording& recording, const std::string& bytes) {
        return files.add(episode_path(request.output, recording), bytes);
    };
    return (!has_targets || embed::embed_targets(*model, asked, *embeddings, sink)) &&
           embed::embed_recordings(*model, *embeddings, recordings, asked, keep, sink) &&
           (!has_targets || files.add(result, embedded::write(*embeddings))) &&
           files.add(std::string(kStandardOutput),
                     source::visible_lines(
                         report(*model, *embeddings, recordings.size(), request.output))) &&
           files.commit();
}

}  // namespace etlc::driver
