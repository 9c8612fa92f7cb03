#include "watch/watch.hpp"

#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "library/version.hpp"

namespace etlc::driver {

bool watch(const source::File& spec, const Compiled& compiled, const Request& request,
           diag::Sink& sink) {
    if (!check_names({compiled.plan.model}, request.names, sink)) return false;
    const std::string& folder = request.watch.record;
    if (!folder.empty() && !make_folder(folder, sink)) return false;
    const watch::Request asked{request.watch.video,
                               request.names,
                               request.embed.running,
                               library::kVersion,
                               request.watch.has_page,
                               request.watch.port,
                               spec.path(),
                               folder,
                               [&](std::string_view text) { return print(text, sink); }};
    return watch::watch(compiled.plan, asked, sink);
}

}  // namespace etlc::driver
