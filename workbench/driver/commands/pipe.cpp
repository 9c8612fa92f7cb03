// `etlc embed --pipe ENCODER`: the encoder of a spec for other programs, such as the Python
// package.
#include <fmt/format.h>

#include <algorithm>

#include "check/check.hpp"
#include "check/encoders/encoders.hpp"
#include "data/files/file.hpp"
#include "driver/commands/commands.hpp"
#include "embed/embed.hpp"
#include "embed/encoder.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"

namespace etlc::driver {

using diag::Code;

bool pipe_frames(const source::File& file, const Request& request, diag::Sink& sink) {
    // This reads the embeddings of the spec, and refuses those of another model or settings.
    check::Options options = request.check;
    options.allow_uncalibrated = true;
    options.allow_uncalibrated_monitors = true;
    options.allow_unfitted = true;
    auto model = check::check(parse::parse(file, sink), file, options, sink);
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

}  // namespace etlc::driver
