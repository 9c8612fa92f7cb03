#include "fit/suggest/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace etlc::fit {

namespace {

constexpr std::uint32_t kFew = 16;
constexpr std::uint32_t kMany = 64;
/// The largest point for a full metric: a step would compare the square of its elements, and a
/// discriminant separates as well for far less.
constexpr std::uint32_t kLargestMetric = 512;

// map, r, discriminant, targets, k, distance, contrast
constexpr Candidate kCandidates[] = {
    {"", 0, false, "mean", 0, "l2", false},
    {"", 0, false, "mean", 0, "l2sq", true},
    {"", 0, false, "medoids", 8, "l2", false},
    {"", 0, false, "medoids", 8, "l2", true},
    {"", 0, false, "kmeans", 32, "l2", true},
    {"", 0, false, "mean", 0, "cosine", true},
    {"", 0, false, "medoids", 8, "cosine", false},
    {"", 0, false, "medoids", 8, "cosine", true},
    {"", 0, false, "mean", 0, "mahalanobis", false},
    {"", 0, false, "mean", 0, "mahalanobis", true},
    {"", 0, true, "mean", 0, "l2", false},
    {"", 0, true, "mean", 0, "l2sq", true},
    {"pca", kFew, false, "medoids", 8, "l2", true},
    {"pca", kFew, false, "kmeans", 32, "l2", true},
    {"pca", kMany, false, "kmeans", 32, "l2", true},
    {"whitened_pca", kFew, false, "mean", 0, "l2", false},
    {"whitened_pca", kFew, false, "medoids", 8, "l2", true},
    {"whitened_pca", kFew, false, "kmeans", 32, "l2", true},
    {"whitened_pca", kMany, false, "mean", 0, "l2", false},
    {"whitened_pca", kMany, false, "medoids", 8, "l2", true},
    {"whitened_pca", kMany, false, "kmeans", 32, "l2", true},
    {"pca", kFew, true, "mean", 0, "l2sq", true},
    {"pca", kMany, true, "mean", 0, "l2sq", true},
};

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::string distance_to(const Candidate& candidate, const std::string& point,
                        const std::string& metric, const std::string& targets) {
    return fmt::format("{}{}({}, {})", candidate.k > 0 ? "min " : "", metric, point, targets);
}

std::string targets_at(const Candidate& candidate, const std::string& point,
                       const std::string& where) {
    return fmt::format("fitted({}, {}of = {}, where = {})", candidate.targets,
                       candidate.k > 0 ? fmt::format("k = {}, ", candidate.k) : "", point, where);
}

}  // namespace

std::set<std::string> words_of(std::string_view spec) {
    std::set<std::string> result;
    auto begin = std::find_if(spec.begin(), spec.end(), is_word);
    while (begin != spec.end()) {
        const auto end = std::find_if_not(begin, spec.end(), is_word);
        result.emplace(begin, end);
        begin = std::find_if(end, spec.end(), is_word);
    }
    return result;
}

std::string Declarations::unused(const std::string& wanted) {
    std::string result = wanted;
    for (int number = 2; !taken_.insert(result).second; ++number)
        result = fmt::format("{}_{}", wanted, number);
    return result;
}

std::string Declarations::name(const std::string& kind, const std::string& role,
                               const std::string& text) {
    for (const Declared& one : declared_)
        if (one.kind == kind && one.text == text) return one.name;
    declared_.push_back({kind, text, unused(prefix_ + "_" + role)});
    lines_.push_back(fmt::format("{} {} = {};", kind, declared_.back().name, text));
    return declared_.back().name;
}

std::vector<Candidate> candidates(std::uint32_t dimension) {
    std::vector<Candidate> result;
    for (const Candidate& candidate : kCandidates)
        if (candidate.r < dimension &&
            (candidate.distance != "mahalanobis" || dimension <= kLargestMetric))
            result.push_back(candidate);
    return result;
}

std::string described(const Candidate& candidate, const std::string& point) {
    std::string from = point;
    if (!candidate.map.empty()) from = fmt::format("{} {}({})", candidate.map, candidate.r, from);
    if (candidate.discriminant) from = fmt::format("discriminant({})", from);
    return distance_to(candidate, from, std::string(candidate.distance),
                       candidate.k > 0 ? fmt::format("{} {}", candidate.k, candidate.targets)
                                       : std::string(candidate.targets)) +
           (candidate.contrast ? ", contrast" : "");
}

std::string expression(const Candidate& candidate, const std::string& point,
                       const std::string& predicate, Declarations& declarations) {
    std::string from = point;
    if (!candidate.map.empty())
        from =
            fmt::format("{}({})",
                        declarations.name("projection", "space",
                                          fmt::format("fitted({}, r = {}, of = {}, where = true)",
                                                      candidate.map, candidate.r, from)),
                        from);
    if (candidate.discriminant)
        from = fmt::format(
            "{}({})",
            declarations.name(
                "projection", "side",
                fmt::format("fitted(discriminant, r = 1, of = {}, where = {})", from, predicate)),
            from);
    std::string metric(candidate.distance);
    if (metric == "mahalanobis")
        metric += fmt::format("(fitted(discriminant, of = {}, where = {}))", from, predicate);
    const std::string to =
        distance_to(candidate, from, metric,
                    declarations.name("target", "inside", targets_at(candidate, from, predicate)));
    if (!candidate.contrast) return to;
    return to + " - " +
           distance_to(candidate, from, metric,
                       declarations.name("target", "outside",
                                         targets_at(candidate, from, "!" + predicate)));
}

}  // namespace etlc::fit
