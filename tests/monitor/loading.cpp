#include "loading.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>

#include "check/check.hpp"
#include "check/formulas/horizons.hpp"
#include "check/guarantees/conformal.hpp"
#include "diag/diag.hpp"
#include "parse/parse.hpp"

namespace etlc::tests {

namespace {

/// As telemetry, if they have a value at every step.
void keep_lets(check::Model& model) {
    const std::vector<check::Reach> reach = check::reaches(model);
    for (check::Let& let : model.lets) let.telemetry = reach[let.formula].future == check::kNone;
}

std::optional<check::Model> load(const std::string& text, const std::string& path,
                                 const check::Options& options) {
    const source::File file(path, text);
    diag::Sink sink;
    ast::Spec spec = parse::parse(file, sink);
    std::optional<check::Model> model;
    if (!sink.has_errors()) model = check::check(std::move(spec), file, options, sink);
    if (!model) ADD_FAILURE() << "the spec was refused:\n" << diag::render_text(file, sink) << text;
    if (model) keep_lets(*model);
    return model;
}

}  // namespace

std::optional<check::Model> load(const std::string& text, const std::string& path) {
    return load(text, path, {});
}

std::optional<check::Model> load_retargetable(const std::string& text) {
    check::Options options;
    options.retargetable = true;
    return load(text, "test.etl", options);
}

std::optional<check::Model> load_with_thresholds(const std::string& text,
                                                 const std::string& thresholds) {
    check::Options options;
    options.thresholds_path = (std::filesystem::temp_directory_path() /
                               fmt::format("etlc-{}.thresholds.json", ::getpid()))
                                  .string();
    std::ofstream(options.thresholds_path) << thresholds;
    auto model = load(text, "test.etl", options);
    std::filesystem::remove(options.thresholds_path);
    return model;
}

std::optional<check::Model> load_uncalibrated(const std::string& text) {
    check::Options options;
    options.allow_uncalibrated = true;
    options.allow_uncalibrated_monitors = true;
    return load(text, "test.etl", options);
}

std::vector<std::string> case_names() {
    std::vector<std::string> result;
    for (const auto& entry :
         std::filesystem::directory_iterator(ETLC_SOURCE_DIR "/tests/monitor/cases"))
        if (entry.path().extension() == ".etl") result.push_back(entry.path().stem().string());
    std::sort(result.begin(), result.end());
    return result;
}

std::string case_path(const std::string& name) {
    return ETLC_SOURCE_DIR "/tests/monitor/cases/" + name;
}

std::string read_text(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) ADD_FAILURE() << path << " cannot be read";
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::vector<std::uint64_t> calibrate_to(float epsilon, bool upper_bound, thresholds::Entry& entry) {
    const double least =
        static_cast<double>(upper_bound ? epsilon : -epsilon) - static_cast<double>(FLT_MIN);
    const double score = std::nextafter(least, -std::numeric_limits<double>::infinity());
    entry.epsilon = epsilon;
    entry.n = check::scores_needed(entry.alpha);
    entry.k = entry.n;
    entry.scores.assign(entry.n, upper_bound ? score : -score);
    std::vector<std::uint64_t> episodes(entry.n);
    std::iota(episodes.begin(), episodes.end(), std::uint64_t{0});
    return episodes;
}

}  // namespace etlc::tests
