// The data of the page: the JSON of its script element "report". Nothing in it can end that
// element; numbers that are not finite are null.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/blob.hpp"
#include "report/pictures.hpp"
#include "report/report.hpp"
#include "report/tracks.hpp"

namespace etlc::report {

/// A row of the list of episodes.
struct Row {
    std::string path;
    std::uint64_t frames = 0;
    std::vector<Outcome> outcomes;
    std::uint64_t missing = 0;  ///< samples, including those out of range
    /// Index in the evaluation's rows, worst first. Without truths rows are ordered by alarm, then
    /// by the least robustness.
    std::size_t rank = 0;
    Blob blob;          ///< empty text if left out
    Pictures pictures;  ///< empty if left out or not requested
};

struct Totals {
    std::uint64_t episodes = 0;
    std::uint64_t steps = 0;
    std::vector<plan::SampleCounts> sample_counts;  ///< per input of the plan
};

/// Returns the declared target of a plain distance, or kNone.
Index declared_target(const check::Model& model, const check::Predicate& predicate);

/// Returns the JSON of the predicates, which takes a pass over all labelled frames.
std::string predicates(const Material& material, const Scene& scene);

/// Returns the document; `rows` are those listed, worst first.
std::string document(const Material& material, const Scene& scene, const std::string& predicates,
                     const Totals& totals, const std::vector<evaluate::EpisodeRow>& judged,
                     const std::vector<Row>& rows);

/// Escapes `<` in JSON for a script element, so that it can close or open no element.
std::string in_script(const std::string& json);

}  // namespace etlc::report
