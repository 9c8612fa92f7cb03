#include "driver/compile/output.hpp"

#include <vector>

#include "data/files/file.hpp"
#include "driver/compile/depfile.hpp"
#include "driver/process/output_file.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::driver {

void write_output(const OutputPaths& paths, const source::File& spec, const Output& output,
                  diag::Sink& sink) {
    std::string rule;
    if (!paths.depfile.empty()) {
        auto made = dependency_rule(paths.result, spec.path(), output.dependencies);
        if (!made) {
            sink.report(data::in_file(made.failure(), paths.depfile));
            return;
        }
        rule = std::move(*made);
    }
    const plan::Plan& plan = output.compiled.plan;
    const bool has_targets = paths.targets_named || !plan.stored.empty();
    std::vector<std::string> inputs = output.dependencies;
    inputs.push_back(spec.path());
    const std::string params = output.params.empty() ? "" : paths.params;
    if (!check_outputs({has_targets ? paths.targets : "", params, paths.depfile, paths.result},
                       inputs, sink))
        return;
    OutputFiles files(sink);
    if (has_targets) {
        const auto write = [&](const std::uint8_t* bytes, std::size_t size) {
            return files.write({reinterpret_cast<const char*>(bytes), size});
        };
        if (!files.begin(paths.targets) || !plan::store(plan, write)) return;
    }
    if (!params.empty() && !files.add(params, output.params)) return;
    if (!paths.depfile.empty() && !files.add(paths.depfile, rule)) return;
    // The result is the last to appear: a build that is stopped in between finds it older than the
    // spec.
    if (files.add(paths.result, output.text)) files.commit();
}

}  // namespace etlc::driver
