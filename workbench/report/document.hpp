// The data of the page, as JSON that the page's programs read.
// Takes: the spec, the judgement, and what became of every episode. Gives: the text of the script
// element "report". Keeps true: nothing in it can end that element; numbers that are not finite are
// null.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/blob.hpp"
#include "report/pictures/pictures.hpp"
#include "report/report.hpp"
#include "report/tracks.hpp"

namespace etlc::report {

/// A row of the list of episodes.
struct Row {
    std::string path;
    std::uint64_t frames = 0;
    std::vector<Outcome> outcomes;
    std::uint64_t missing = 0;  ///< samples, those out of range too
    /// Its place in the evaluation's rows, which put the worst first; without truths among alarms
    /// first, then by the least robustness.
    std::size_t rank = 0;
    Blob blob;          ///< empty text: left out
    Pictures pictures;  ///< none: left out, or not asked for
};

struct Totals {
    std::uint64_t episodes = 0;
    std::uint64_t steps = 0;
    std::vector<plan::SampleCounts> sample_counts;  ///< per input of the plan
};

/// The target of a plain distance, as the spec declares it; kNone: there is none.
Index declared_target(const check::Model& model, const check::Predicate& predicate);

/// `rows`: those that are listed, the worst first.
std::string document(const Material& material, const Scene& scene, const Totals& totals,
                     const std::vector<evaluate::EpisodeRow>& judged, const std::vector<Row>& rows);

/// JSON that stands in a script element: `<` is written so that none can be closed or opened.
std::string in_script(const std::string& json);

}  // namespace etlc::report
