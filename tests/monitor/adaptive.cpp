#include "adaptive.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <regex>
#include <sstream>

#include "artifacts/thresholds.hpp"
#include "check/guarantees/provenance.hpp"
#include "loading.hpp"
#include "random.hpp"

namespace etlc::tests {
namespace {

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

/// Matches "predicate p0 = min l1(v, near) <= 1.25;" and adds a range of at least gamma around
/// 1.25, with no end below 0 unless 1.25 is.
std::string made_adaptive(const std::string& line, Random& random) {
    const std::size_t blank = line.find_last_of(' ');
    const double literal = std::stod(line.substr(blank + 1));
    double lo = literal - random.grid(0, 1, 0.25);
    if (literal >= 0) lo = std::max(lo, 0.0);
    const double hi = std::max(lo + 1, literal + random.grid(0, 1.5, 0.25));
    return fmt::format("{} calibrated(adaptive, alpha = 0.25, gamma = {}, lo = {}, hi = {});",
                       line.substr(0, blank), random.word({"0.25", "0.5", "1"}), lo, hi);
}

thresholds::Entry entry(const check::Model& model, check::Index predicate, float start,
                        std::vector<std::uint64_t>& episodes) {
    thresholds::Entry result;
    result.method = "adaptive";
    result.alpha = "0.25";
    episodes = calibrate_to(start, model.predicates[predicate].upper_bound(), result);
    result.reads = check::reads(model, predicate);
    return result;
}

/// Returns the miss of a positive frame, by the comparison itself.
bool misses(const check::Predicate& predicate, double distance, double epsilon) {
    switch (predicate.comparison) {
        case check::Comparison::less_equal: return !(distance <= epsilon);
        case check::Comparison::less: return !(distance < epsilon);
        case check::Comparison::greater_equal: return !(distance >= epsilon);
        case check::Comparison::greater: return !(distance > epsilon);
        case check::Comparison::equal:
        case check::Comparison::not_equal: break;
    }
    ADD_FAILURE() << "an adaptive threshold is never one of equality";
    return false;
}

/// epsilon += gamma (miss - alpha) within [lo, hi], for >= and > epsilon -= gamma (miss - alpha).
double moved(const check::Predicate& predicate, double epsilon, const Label& label) {
    if (!label.truth || std::isnan(label.distance)) return epsilon;
    const check::Adaptation& adaptation = *predicate.threshold.adaptation;
    const double miss = misses(predicate, static_cast<double>(label.distance), epsilon) ? 1 : 0;
    const double by = std::stod(adaptation.gamma) * (miss - std::stod(predicate.threshold.alpha));
    return std::clamp(predicate.upper_bound() ? epsilon + by : epsilon - by,
                      std::stod(adaptation.lo), std::stod(adaptation.hi));
}

/// Returns the number at the end of a predicate that may have an adaptive threshold in its place;
/// nothing for equalities, constants and predicates that say what a missing sample means.
std::optional<float> number_compared_with(const std::string& line) {
    static const std::regex kOrdered(R"(predicate \w+ = [^=!]*[<>]=? (-?[0-9.]+);)");
    std::smatch match;
    if (!std::regex_match(line, match, kOrdered)) return {};
    return std::stof(match[1]);
}

}  // namespace

AdaptiveSpec random_adaptive_spec(std::uint64_t seed, const SpecShape& shape) {
    Random random(seed ^ 0x5eedULL);
    AdaptiveSpec result;
    std::vector<float> starts;
    std::istringstream lines(random_spec(seed, shape));
    for (std::string line; std::getline(lines, line);) {
        const auto start = number_compared_with(line);
        const bool adaptive = start && random.chance(0.7);
        if (line.starts_with("predicate ")) starts.push_back(start.value_or(0));
        result.text += (adaptive ? made_adaptive(line, random) : line) + "\n";
    }
    const auto uncalibrated = load_uncalibrated(result.text);
    if (!uncalibrated) return result;
    thresholds::File file;
    file.spec = uncalibrated->name;
    for (check::Index p = 0; p < starts.size(); ++p)
        if (uncalibrated->predicates[p].threshold.adaptation)
            file.predicates[uncalibrated->predicates[p].name] =
                entry(*uncalibrated, p, starts[p], file.episodes);
    result.thresholds = thresholds::write(file);
    result.model = load_with_thresholds(result.text, result.thresholds);
    return result;
}

Labels random_labels(const check::Model& model, const reference::Trace& trace, std::uint64_t seed) {
    Random random(seed);
    const auto telemetry = reference::evaluate(model, trace).telemetry;
    const auto distance = [&](std::size_t step, std::size_t predicate) {
        if (random.chance(0.1)) return random.chance(0.5) ? kFloatInfinity : -kFloatInfinity;
        if (random.chance(0.1)) return std::numeric_limits<float>::quiet_NaN();
        if (step == 0 || random.chance(0.3)) return static_cast<float>(random.grid(-4, 8, 0.25));
        return static_cast<float>(
            telemetry[random.between(0, static_cast<int>(step) - 1)][predicate].delta);
    };
    Labels labels(trace.size());
    for (std::size_t step = 0; step < trace.size(); ++step) {
        labels[step].resize(model.predicates.size());
        for (std::size_t p = 0; p < model.predicates.size(); ++p)
            for (int n = random.between(-1, 2); n > 0; --n)
                labels[step][p].push_back({distance(step, p), random.chance(0.8)});
    }
    return labels;
}

std::vector<double> calibrated_thresholds(const check::Model& model) {
    std::vector<double> result;
    for (const check::Predicate& predicate : model.predicates)
        result.push_back(static_cast<double>(predicate.threshold.value));
    return result;
}

reference::Thresholds tracked(const check::Model& model, const Labels& labels,
                              std::vector<double>& now) {
    reference::Thresholds result;
    for (const auto& step : labels) {
        for (std::size_t p = 0; p < model.predicates.size(); ++p)
            if (model.predicates[p].threshold.adaptation)
                for (const Label& label : step[p])
                    now[p] = moved(model.predicates[p], now[p], label);
        result.push_back(now);
    }
    return result;
}

}  // namespace etlc::tests
