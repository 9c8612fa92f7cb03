// The data of the page: the JSON of its script element "report". Nothing in it can end that
// element; numbers that are not finite are null.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/report.hpp"
#include "report/tracks.hpp"

namespace etlc::report {

struct Totals {
    std::uint64_t episodes = 0;
    std::uint64_t steps = 0;
    std::vector<execute::SampleCounts> sample_counts;  ///< per input of the plan
};

/// Returns the declared target of a plain distance, or kNone.
Index declared_target(const check::Model& model, const check::Predicate& predicate);

/// Returns the JSON of the predicates, which takes a pass over all labelled frames.
std::string predicates(const Material& material, const Scene& scene);

/// Returns the document up to its rows, which commas separate and kEnd ends.
std::string head(const Material& material, const Scene& scene, const std::string& predicates,
                 const Totals& totals);
inline constexpr std::string_view kEnd = "]}";
/// Returns a row; `judged`: its evaluation, or null.
std::string text_of(const Row& row, const evaluate::EpisodeRow* judged);

/// Escapes `<` in JSON for a script element, so that it can close or open no element.
std::string in_script(const std::string& json);

}  // namespace etlc::report
