#include "driver/options/embed_options.hpp"

#include "driver/fleet/options.hpp"
#include "driver/options/options.hpp"
#include "driver/options/spec_options.hpp"

namespace etlc::driver {

void add_embed_options(CLI::App& app, EmbedRequest& request) {
    add_set_option(app, request.settings);
    app.add_option("--data", request.data,
                   "recordings to make episodes of: videos, folders of images, folders and "
                   "'patterns' of these")
        ->type_name("FILE...");
    app.add_option("-o,--output", request.output, "folder where the episodes go, as .npz")
        ->type_name("FOLDER");
    app.add_option("--embedded", request.embedded,
                   "where what the spec names goes, encoded (default: SPEC.embedded.npz beside "
                   "the spec)")
        ->type_name("FILE");
    add_shard_option(app, request.shard,
                     "make episodes of this shard of the recordings only; the first encodes what "
                     "the spec names as well");
    app.add_option("--encoder-cmd", request.embed.running.command,
                   "a command that encodes: frames on its standard input, embeddings on its "
                   "standard output (docs/encoders.md)")
        ->type_name("COMMAND");
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
