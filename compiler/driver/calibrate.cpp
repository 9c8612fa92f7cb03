#include "driver/calibrate.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "check/check.hpp"
#include "data/file.hpp"
#include "driver/names.hpp"
#include "driver/version.hpp"
#include "parse/parse.hpp"

namespace etlc::driver {

namespace {

void show_progress(std::size_t done, std::size_t total) {
    fmt::print(stderr, "\r{} of {} episodes", done, total);
    if (done == total) fmt::print(stderr, "\r{:40}\r", "");
}

}  // namespace

bool calibrate(const source::File& file, const CalibrateRequest& request, diag::Sink& sink) {
    const ast::Spec spec = parse::parse(file, sink);
    check::Options options;
    options.allow_uncalibrated = true;
    const auto model = check::check(spec, file, options, sink);
    if (!model || sink.has_errors() || (request.warnings_are_errors && sink.warnings() > 0)) return false;

    calibrate::Request calibration = request.calibration;
    if (!check_names(*model, calibration.names, sink)) return false;
    calibration.version = kVersion;
    if (request.progress) calibration.progress = show_progress;
    const auto result = calibrate::calibrate(*model, calibration, sink);
    if (!result) return false;

    const std::string output = request.output.empty() ? check::default_thresholds_path(file.path()) : request.output;
    const bool to_stdout = output == "-";
    const auto failure = data::write_file_atomically(to_stdout ? "/dev/stdout" : output,
                                                     thresholds::write(result->file), diag::Code::unwritable_output);
    if (failure) {
        sink.report(data::in_file(*failure, output));
        return false;
    }
    fmt::print(to_stdout ? stderr : stdout, "{}", result->report);
    return true;
}

}  // namespace etlc::driver
