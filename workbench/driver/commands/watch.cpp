#include "watch/watch.hpp"

#include <filesystem>

#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "library/version.hpp"

namespace etlc::driver {

bool watch(const source::File& spec, const Compiled& compiled, const Request& request,
           diag::Sink& sink) {
    if (!check_names({compiled.plan.model}, request.names, sink)) return false;
    const std::string& folder = request.watch.record;
    std::error_code error;
    if (!folder.empty()) std::filesystem::create_directories(folder, error);
    if (error) {
        sink.report(data::in_file(
            {diag::Code::unwritable_output, fmt::format("cannot be made: {}", error.message())},
            folder));
        return false;
    }
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
