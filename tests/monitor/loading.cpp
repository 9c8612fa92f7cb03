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
#include <regex>
#include <sstream>

#include "check/check.hpp"
#include "check/formulas/horizons.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/guarantees/provenance.hpp"
#include "diag/diag.hpp"
#include "parse/parse.hpp"
#include "random.hpp"

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

namespace {

/// The threshold of one side from n equal scores, the fewest that alpha allows; from one less if it
/// is infinite.
void set_side(float epsilon, bool above, const std::string& alpha, thresholds::Side& side) {
    const bool is_infinite = std::isinf(epsilon);
    const double least =
        static_cast<double>(above ? epsilon : -epsilon) - static_cast<double>(FLT_MIN);
    const double score =
        is_infinite ? 0 : std::nextafter(least, -std::numeric_limits<double>::infinity());
    side.epsilon = epsilon;
    side.n = check::scores_needed(alpha) - (is_infinite ? 1 : 0);
    side.k = side.n + (is_infinite ? 1 : 0);
    side.scores.assign(side.n, above ? score : -score);
}

}  // namespace

std::vector<std::uint64_t> calibrate_to(float epsilon, bool above, thresholds::Entry& entry,
                                        std::optional<float> inner) {
    set_side(epsilon, above, entry.alpha, entry);
    if (inner) set_side(*inner, !above, entry.alpha, entry.inner.emplace());
    std::vector<std::uint64_t> episodes(
        std::max(entry.n, entry.inner ? entry.inner->n : std::uint64_t{0}));
    std::iota(episodes.begin(), episodes.end(), std::uint64_t{0});
    return episodes;
}

CalibratedSpec with_two_thresholds(const std::string& spec, std::uint64_t seed) {
    Random random(seed ^ 0xb07bULL);
    CalibratedSpec result;
    std::istringstream lines(spec);
    const std::regex form(
        R"((predicate \w+ = .* (<=|<|>=|>) )(-?[0-9][0-9.e-]*)((?: missing \w+)?;))");
    for (std::string line; std::getline(lines, line);) {
        std::smatch parts;
        if (random.chance(0.7) && std::regex_match(line, parts, form)) {
            result.literals.push_back(std::stof(parts[3]));
            line = fmt::format("{}calibrated(conformal, alpha = 0.1, against = both){}",
                               parts[1].str(), parts[4].str());
        }
        result.text += line + "\n";
    }
    const auto uncalibrated = load_uncalibrated(result.text);
    if (!uncalibrated) return result;
    thresholds::File file;
    file.spec = uncalibrated->name;
    auto literal = result.literals.begin();
    for (check::Index p = 0; p < uncalibrated->predicates.size(); ++p) {
        const check::Predicate& predicate = uncalibrated->predicates[p];
        if (predicate.threshold.origin == check::ThresholdOrigin::literal) continue;
        const bool above = predicate.upper_bound();
        const float outer = *literal++;
        // Apart, equal, in the wrong order (separated), or too few scores for one side.
        const float apart = static_cast<float>(random.grid(-1, 3, 0.5));
        const float inner = above ? outer - apart : outer + apart;
        const bool has_outer = random.chance(0.9);
        const bool has_inner = !has_outer || random.chance(0.9);
        thresholds::Entry& entry = file.predicates[predicate.name];
        entry.method = "conformal";
        entry.alpha = "0.1";
        entry.against = "both";
        const auto episodes = calibrate_to(has_outer ? outer : check::infinite(above), above, entry,
                                           has_inner ? inner : check::infinite(!above));
        if (episodes.size() > file.episodes.size()) file.episodes = episodes;
        entry.reads = check::reads(*uncalibrated, p);
    }
    result.thresholds = thresholds::write(file);
    result.model = load_with_thresholds(result.text, result.thresholds);
    return result;
}

}  // namespace etlc::tests
