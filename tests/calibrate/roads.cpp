#include "roads.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "diag/diag.hpp"
#include "driver/commands/commands.hpp"
#include "parse/parse.hpp"

namespace etlc::tests {

void Files::add(const std::string& text) {
    paths_.push_back(fmt::format("{}{}.csv", folder_->path(), paths_.size()));
    std::ofstream(paths_.back()) << text;
}

Calibrated calibrated(const std::string& spec, const std::vector<std::string>& episodes,
                      const std::string& before, const std::string& fitted) {
    const TemporaryPath thresholds("before.json", before);
    const TemporaryPath fits("fits.npz", fitted);
    const TemporaryPath output("after.json");
    driver::Request request;
    request.data = episodes;
    request.jobs = 1;
    request.output = output.path();
    if (!before.empty()) request.check.thresholds_path = thresholds.path();
    if (!fitted.empty()) request.check.fitted_path = fits.path();
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

std::string numbers(const std::string& thresholds) {
    if (thresholds.empty()) return "";
    const auto file = nlohmann::json::parse(thresholds);
    std::string text;
    for (const char* kind : {"predicates", "monitors"})
        for (const auto& [name, entry] : file[kind].items())
            text += name + entry["epsilon"].dump() + entry["scores"].dump() + entry["n"].dump() +
                    entry["k"].dump() + "\n";
    return text;
}

std::string fitted(const std::string& spec, const std::vector<std::string>& episodes) {
    const TemporaryPath output("fits.npz");
    driver::Request request;
    request.data = episodes;
    request.jobs = 1;
    request.output = output.path();
    diag::Sink sink;
    testing::internal::CaptureStdout();
    const bool done = driver::fit(source::File("t.etl", spec), request, sink);
    testing::internal::GetCapturedStdout();
    return done ? file_bytes(output.path()) : "";
}

Checked checked(const std::string& spec, const std::string& thresholds, const std::string& fitted) {
    const TemporaryPath path("t.json", thresholds);
    const TemporaryPath fits("fits.npz", fitted);
    check::Options options;
    options.thresholds_path = path.path();
    options.fitted_path = fits.path();
    diag::Sink sink;
    const source::File file("t.etl", spec);
    Checked result;
    result.model = check::check(parse::parse(file, sink), file, options, sink);
    result.codes = error_codes(sink);
    result.text = diag::render_text(file, sink);
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
