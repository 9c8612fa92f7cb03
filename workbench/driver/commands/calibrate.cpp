#include <fmt/format.h>

#include <optional>
#include <string>

#include "calibrate/calibrate.hpp"
#include "calibrate/shift.hpp"
#include "check/check.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"
#include "recordings/open.hpp"
#include "source/text.hpp"

namespace etlc::driver {

namespace {

using calibrate::Calibration;

/// Calibrates the predicates; or, with their thresholds, the monitors on other episodes.
std::optional<Calibration> calibrate_model(const check::Model& model, const Request& request,
                                           const calibrate::Request& calibration,
                                           diag::Sink& sink) {
    const bool has_monitors = !calibrate::calibrated_monitors(model).empty();
    const bool has_predicates = !calibrate::calibrated_predicates(model).empty();
    if (request.check.thresholds_path.empty()) {
        if (has_monitors && !has_predicates)
            return calibrate::calibrate_monitors(model, {}, calibration, sink);
        auto result = calibrate::calibrate(model, calibration, sink);
        if (result && has_monitors)
            result->report +=
                "\nMonitors that are calibrated as a whole, or with a duration, come next, on "
                "other "
                "episodes: etlc calibrate --thresholds FILE\n";
        return result;
    }
    if (!has_monitors) {
        sink.report(
            diag::Code::nothing_to_calibrate, model.monitors.front().span,
            "no monitor of this spec is calibrated, as a whole or with a duration, which is what "
            "--thresholds is for");
        return std::nullopt;
    }
    auto before = thresholds::read(request.check.thresholds_path);
    if (!before) {
        sink.report(data::in_file(before.failure(), request.check.thresholds_path));
        return std::nullopt;
    }
    return calibrate::calibrate_monitors(model, std::move(*before), calibration, sink);
}

/// Returns the files that may not be overwritten. The file of thresholds may: those of the monitors
/// are added to it.
std::vector<std::string> inputs(const check::Model& model, const source::File& file,
                                const Request& request, const calibrate::Request& calibration) {
    auto paths = files_read(model, file, calibration.episodes, calibration.reading);
    std::erase(paths, request.check.thresholds_path);
    for (const std::string& part : merged_files(calibration.sharing)) paths.push_back(part);
    return paths;
}

/// Fails where the thresholds to which those of monitors are added are no longer those that were
/// read: another call has written them meanwhile, and its thresholds would be lost.
data::StillRight still_as_read(const std::string& thresholds) {
    if (thresholds.empty()) return nullptr;
    const auto hash = [thresholds] {
        const auto found = data::hash_of_file(thresholds, diag::Code::unreadable_thresholds);
        return found ? *found : "";
    };
    return [hash, thresholds, before = hash()]() -> std::optional<diag::Failure> {
        if (hash() == before) return std::nullopt;
        return diag::Failure{
            diag::Code::unwritable_output,
            fmt::format("is not written: another program has changed {} since it was read; "
                        "calibrate the monitors again",
                        thresholds)};
    };
}

/// Returns the files that scores depend on, besides the episodes.
std::vector<std::string> loaded(const check::Model& model, const source::File& file,
                                const std::string& output, const episodes::ReadOptions& reading) {
    auto paths = files_read(model, file, {}, reading);
    std::erase(paths, output);
    return paths;
}

}  // namespace

bool calibrate(const source::File& file, const Request& request, diag::Sink& sink) {
    const auto as_read = still_as_read(request.check.thresholds_path);
    ast::Spec spec = parse::parse(file, sink);
    check::Options options = request.check;
    options.allow_uncalibrated = options.thresholds_path.empty();
    options.allow_uncalibrated_monitors = true;
    const auto model = check::check(std::move(spec), file, options, sink);
    if (!model || sink.refused()) return false;

    auto shard = sharing_of(request);
    auto calibration = asked_of<calibrate::Request>(request);
    calibration.sharing = shard ? &*shard : request.merged;
    calibration.allow_overlap = request.allow_overlap;
    calibration.folds = request.folds;
    if (!check_names({&*model}, calibration.reading.names, sink)) return false;
    calibration.episodes =
        find_shared_episodes(calibration.sharing, request.data, request.chosen, sink);
    if (sink.has_errors()) return false;
    if (!read_labels({&*model}, request, calibration.episodes, calibration.reading, sink))
        return false;
    calibration.version = library::kVersion;
    calibration.fitted = fitted_file(*model, file.path(), request);
    const std::string output =
        request.output.empty() ? check::default_thresholds_path(file.path()) : request.output;
    if (!check_outputs({is_shard(calibration.sharing) ? request.shard.part : output},
                       inputs(*model, file, request, calibration), sink))
        return false;
    if (!note_loaded(calibration.sharing, loaded(*model, file, output, calibration.reading), sink))
        return false;
    const auto result = calibrate_model(*model, request, calibration, sink);
    if (is_shard(calibration.sharing))
        return write_part(*calibration.sharing, request.shard.part, sink);
    if (!result || sink.refused()) return false;

    // The report is written before the file takes its name: where that fails, nothing has changed.
    OutputFiles files(sink);
    return files.begin(output) &&
           thresholds::write(result->file,
                             [&](std::string_view piece) { return files.write(piece); }) &&
           files.add(output == kStandardOutput ? "/dev/stderr" : std::string(kStandardOutput),
                     source::visible_lines(result->report)) &&
           files.commit(as_read);
}

}  // namespace etlc::driver
