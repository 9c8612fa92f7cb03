#include "driver/options/spec_options.hpp"

#include "driver/options/options.hpp"
#include "library/settings.hpp"

namespace etlc::driver {

void add_set_option(CLI::App& app, std::vector<check::Setting>& settings) {
    const auto read = [&settings](const std::vector<std::string>& words) {
        std::string mistake;
        auto parsed = library::parse_settings(words, mistake);
        if (!parsed) throw CLI::ValidationError(mistake);
        settings = std::move(*parsed);
    };
    app.add_option_function<std::vector<std::string>>(
           "--set", read, "another value for a constant: --set limit=0.25, --set deadline=2s")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
}

void add_diagnostics_options(CLI::App& app, std::vector<std::string>& warnings,
                             std::string& diagnostics) {
    app.add_option("-W", warnings, "-Werror: warnings are errors")
        ->type_name("error")
        ->check(one_of({"error"}));
    app.add_option("--diagnostics", diagnostics, "how to print them")
        ->type_name("")
        ->check(one_of({"text", "json"}))
        ->capture_default_str();
}

void add_fitted_option(CLI::App& app, std::string& path) {
    app.add_option("--fitted", path,
                   "what 'etlc fit' found (default: SPEC.fitted.npz beside the spec, where it "
                   "exists)")
        ->type_name("FILE");
}

void add_embedded_option(CLI::App& app, std::string& path) {
    app.add_option("--embedded", path,
                   "what 'etlc embed' made of images and videos (default: SPEC.embedded.npz beside "
                   "the spec)")
        ->type_name("FILE");
}

void add_compiler_options(CLI::App& app, Request& request) {
    add_set_option(app, request.check.settings);
    app.add_option(
           "--thresholds", request.check.thresholds_path,
           "calibrated thresholds (default: SPEC.thresholds.json beside the spec, where it exists)")
        ->type_name("FILE");
    add_fitted_option(app, request.check.fitted_path);
    add_embedded_option(app, request.check.embedded_path);
    add_choice<check::Values>(
        app, "--values", request.values,
        {{"robustness", check::Values::robustness}, {"boolean", check::Values::boolean}},
        "what monitors compute with; boolean: truth values, and only what can still change a "
        "verdict");
    add_choice<plan::Storage>(
        app, "--targets-as", request.targets_as,
        {{"f32", plan::Storage::f32}, {"f16", plan::Storage::f16}, {"i8", plan::Storage::i8}},
        "how target sets are stored for measuring; what that leaves open is measured in float32 "
        "as well");
    add_limit(app, "--max-state", request.limits.state_bytes, "most bytes of state");
    add_limit(app, "--max-code", request.limits.code_bytes,
              "most bytes of code, estimated, targets aside");
    add_limit(app, "--max-work", request.limits.operations,
              "most operations of the temporal part a step");
}

}  // namespace etlc::driver
