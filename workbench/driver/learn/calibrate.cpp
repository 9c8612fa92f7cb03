#include "driver/learn/calibrate.hpp"

#include "calibrate/shift.hpp"
#include "check/check.hpp"
#include "data/files/file.hpp"
#include "data/recordings/open.hpp"
#include "driver/compile/names.hpp"
#include "driver/learn/fit.hpp"
#include "driver/process/output_file.hpp"
#include "driver/process/progress.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"
#include "source/escape.hpp"

namespace etlc::driver {

namespace {

using calibrate::Calibration;

/// Predicates first; then, on other episodes, the monitors with these thresholds in them.
std::optional<Calibration> calibrate_model(const check::Model& model,
                                           const CalibrateRequest& request,
                                           const calibrate::Request& calibration,
                                           diag::Sink& sink) {
    const bool has_monitors = !calibrate::calibrated_monitors(model).empty();
    const bool has_predicates = !calibrate::calibrated_predicates(model).empty();
    if (request.thresholds.empty()) {
        if (has_monitors && !has_predicates)
            return calibrate::calibrate_monitors(model, {}, calibration, sink);
        auto result = calibrate::calibrate(model, calibration, sink);
        if (result && has_monitors)
            result->report +=
                "\nMonitors that are calibrated as a whole come next, on other episodes: etlc "
                "calibrate --thresholds FILE\n";
        return result;
    }
    if (!has_monitors) {
        sink.report(
            diag::Code::nothing_to_calibrate, model.monitors.front().span,
            "no monitor of this spec is calibrated as a whole, which is what --thresholds is for");
        return std::nullopt;
    }
    auto before = thresholds::read(request.thresholds);
    if (!before) {
        sink.report(data::in_file(before.failure(), request.thresholds));
        return std::nullopt;
    }
    return calibrate::calibrate_monitors(model, std::move(*before), calibration, sink);
}

/// What may not be written over. Thresholds may: those of the monitors come to those of the
/// predicates.
std::vector<std::string> inputs(const check::Model& model, const source::File& file,
                                const CalibrateRequest& request,
                                const std::vector<std::string>& episodes) {
    std::vector<std::string> paths = merged_files(request.calibration.sharing);
    for (const std::string& episode : episodes) paths.push_back(data::trace_file(episode));
    paths.push_back(file.path());
    for (const std::string& path : model.dependencies)
        if (path != request.thresholds) paths.push_back(path);
    return paths;
}

/// What the scores of an episode come from.
std::vector<std::string> loaded(const check::Model& model, const source::File& file,
                                const std::string& output) {
    std::vector<std::string> paths = {file.path()};
    for (const std::string& path : model.dependencies)
        if (path != output) paths.push_back(path);
    return paths;
}

}  // namespace

bool calibrate(const source::File& file, const CalibrateRequest& request, diag::Sink& sink) {
    ast::Spec spec = parse::parse(file, sink);
    check::Options options;
    options.settings = request.settings;
    options.thresholds_path = request.thresholds;
    options.fitted_path = request.fitted;
    options.embedded_path = request.embedded;
    options.allow_uncalibrated = request.thresholds.empty();
    options.allow_uncalibrated_monitors = true;
    const auto model = check::check(std::move(spec), file, options, sink);
    if (!model || sink.refused()) return false;

    calibrate::Request calibration = request.calibration;
    if (!check_names({&*model}, calibration.names, sink)) return false;
    calibration.episodes =
        find_shared_episodes(calibration.sharing, request.data, request.groups, sink);
    if (sink.has_errors()) return false;
    calibration.version = library::kVersion;
    calibration.fitted = fitted_file(*model, file.path(), request.fitted);
    calibration.progress = episodes_progress();
    const std::string output =
        request.output.empty() ? check::default_thresholds_path(file.path()) : request.output;
    if (!check_outputs({is_shard(calibration.sharing) ? request.shard.part : output},
                       inputs(*model, file, request, calibration.episodes), sink))
        return false;
    if (!note_loaded(calibration.sharing, loaded(*model, file, output), sink)) return false;
    const auto result = calibrate_model(*model, request, calibration, sink);
    if (is_shard(calibration.sharing))
        return write_part(*calibration.sharing, request.shard.part, sink);
    if (!result || sink.refused()) return false;

    // The report comes before the file takes its name: where a part of it is lost, nothing has
    // changed.
    OutputFiles files(sink);
    return files.begin(output) &&
           thresholds::write(result->file,
                             [&](std::string_view piece) { return files.write(piece); }) &&
           files.add(output == kStandardOutput ? "/dev/stderr" : std::string(kStandardOutput),
                     source::visible_lines(result->report)) &&
           files.commit();
}

}  // namespace etlc::driver
