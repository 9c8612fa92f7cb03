#include "roads.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "driver/learn/calibrate.hpp"

namespace etlc::tests {

void Files::add(const std::string& text) {
    files_.push_back(std::make_unique<TemporaryPath>(fmt::format("{}.csv", files_.size()), text));
    paths_.push_back(files_.back()->path());
}

Calibrated calibrated(const std::string& spec, const std::vector<std::string>& episodes,
                      const std::string& before) {
    const TemporaryPath thresholds("before.json", before);
    const TemporaryPath output("after.json");
    driver::CalibrateRequest request;
    request.data = episodes;
    request.calibration.jobs = 1;
    request.output = output.path();
    if (!before.empty()) request.thresholds = thresholds.path();
    diag::Sink sink;
    testing::internal::CaptureStdout();
    const bool done = driver::calibrate(source::File("t.etl", spec), request, sink);
    Calibrated result;
    result.report = testing::internal::GetCapturedStdout();
    result.codes = error_codes(sink);
    if (done) result.thresholds = file_bytes(output.path());
    EXPECT_EQ(done, result.codes.empty());
    return result;
}

std::vector<std::string> error_codes(const diag::Sink& sink) {
    std::vector<std::string> codes;
    for (const diag::Diagnostic& finding : sink.sorted()) {
        const std::string code(diag::info(finding.code).code);
        const bool known = std::find(codes.begin(), codes.end(), code) != codes.end();
        if (finding.severity() == diag::Severity::error && !known) codes.push_back(code);
    }
    return codes;
}

}  // namespace etlc::tests
