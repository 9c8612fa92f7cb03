#include "driver/options/embed_options.hpp"

#include <map>
#include <string>
#include <vector>

#include "driver/fleet/options.hpp"
#include "driver/options/options.hpp"
#include "driver/options/recording_options.hpp"
#include "driver/options/spec_options.hpp"

namespace etlc::driver {

namespace {

/// NAME, the camera of all inputs, or INPUT=NAME.
void add_camera_option(CLI::App& app, std::map<std::string, std::string>& cameras) {
    const auto read = [&cameras](const std::vector<std::string>& words) {
        for (const std::string& word : words) {
            const std::size_t sign = word.find('=');
            const std::string input = sign == std::string::npos ? "" : word.substr(0, sign);
            const std::string camera = sign == std::string::npos ? word : word.substr(sign + 1);
            if (camera.empty() || sign == 0)
                throw CLI::ValidationError("--camera takes NAME or INPUT=NAME, not '" + word + "'");
            if (!cameras.emplace(input, camera).second)
                throw CLI::ValidationError(
                    "--camera names " + (input.empty() ? "two cameras" : "'" + input + "' twice"));
        }
    };
    app.add_option_function<std::vector<std::string>>(
           "--camera", read,
           "the camera of a data set, or the array of images: observation.images.top; where inputs "
           "have different ones, z=observation.images.top")
        ->type_name("[INPUT=]NAME");
}

}  // namespace

void add_embed_options(CLI::App& app, EmbedRequest& request) {
    add_set_option(app, request.settings);
    app.add_option("--data", request.data,
                   "recordings to make episodes of: videos, folders of images, data sets, .npz and "
                   ".h5 files of images, folders and 'patterns' of these")
        ->type_name("FILE...");
    add_camera_option(app, request.cameras);
    add_map_option(app, request.embed.names);
    app.add_option("--episodes", request.groups,
                   "groups of .h5 files that are recordings: 'data/*'")
        ->type_name("PATTERN");
    app.add_option("-o,--output", request.output, "folder where the episodes go, as .npz")
        ->type_name("FOLDER");
    app.add_option("--embedded", request.embedded,
                   "where what the spec names goes, encoded (default: SPEC.embedded.npz beside "
                   "the spec)")
        ->type_name("FILE");
    add_shard_option(app, request.shard,
                     "make episodes of this shard of the recordings only; the first encodes what "
                     "the spec names as well");
    CLI::Option* const library =
        app.add_option("--onnxruntime", request.embed.running.onnxruntime,
                       "what runs the models of encoders: the library, or a folder that has it "
                       "(default: ETLC_ONNXRUNTIME, or where pip, npm or the system put it)")
            ->type_name("PATH");
    app.add_option("--encoder-cmd", request.embed.running.command,
                   "a command that encodes: frames on its standard input, embeddings on its "
                   "standard output (docs/encoders.md)")
        ->type_name("COMMAND")
        ->excludes(library);
    add_number(app, "--encoder-timeout", request.embed.running.max_silence_seconds,
               "seconds after which an encoder that neither reads nor writes is stopped", 1, 86400)
        ->default_str(std::to_string(request.embed.running.max_silence_seconds));
}

std::string mistake_in_embed_call(const EmbedRequest& request) {
    if (request.data.empty() != request.output.empty())
        return request.data.empty() ? "-o takes the episodes of --data, which is missing"
                                    : "--data needs -o FOLDER, where the episodes go";
    if (request.shard.shards > 0 && request.data.empty())
        return "--shard takes a part of the recordings of --data, which is missing";
    return "";
}

}  // namespace etlc::driver
