#include "driver/output.hpp"

#include <vector>

#include "driver/output_file.hpp"
#include "plan/stored.hpp"

namespace etlc::driver {

namespace {

/// "monitor.hpp: spec.etl targets/a.npy", as make and ninja read it.
std::string dependency_rule(const std::string& output, const std::string& spec, const std::vector<std::string>& files) {
    const auto escaped = [](const std::string& path) {
        std::string text;
        for (char c : path) {
            if (c == ' ' || c == '#') text += '\\';
            if (c == '$') text += '$';
            text += c;
        }
        return text;
    };
    std::string rule = escaped(output) + ": " + escaped(spec);
    for (const std::string& file : files) rule += " \\\n  " + escaped(file);
    return rule + "\n";
}

}  // namespace

void write_output(const OutputPaths& paths, const source::File& spec, const Output& output, diag::Sink& sink) {
    const plan::Plan& plan = output.compiled.plan;
    const bool has_targets = paths.targets_named || !plan.stored.empty();
    std::vector<std::string> inputs = output.dependencies;
    inputs.push_back(spec.path());
    if (!check_outputs({has_targets ? paths.targets : "", paths.depfile, paths.result}, inputs, sink)) return;
    OutputFiles files(sink);
    if (has_targets) {
        const auto write = [&](const std::uint8_t* bytes, std::size_t size) {
            return files.write({reinterpret_cast<const char*>(bytes), size});
        };
        if (!files.begin(paths.targets) || !plan::store(plan, write)) return;
    }
    if (!paths.depfile.empty() &&
        !files.add(paths.depfile, dependency_rule(paths.result, spec.path(), output.dependencies)))
        return;
    // The result is the last to appear: a build that is stopped in between finds it older than the spec.
    if (files.add(paths.result, output.text)) files.commit();
}

}  // namespace etlc::driver
