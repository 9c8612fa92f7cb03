// The data of the page: the JSON of its script element "report". Nothing in it can end that
// element; numbers that are not finite are null.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "report/report.hpp"
#include "report/tracks.hpp"

namespace etlc::report {

struct Totals {
    std::uint64_t episodes = 0;
    std::uint64_t steps = 0;
    std::vector<std::int64_t> unknown;  ///< steps, of the scene's predicates, then of the monitors
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

// The page: its own files, the chart library and the data in one HTML text. A browser runs only the
// two programs that etlc was built with and requests nothing from a network: the page's
// Content-Security-Policy lists their hashes, and no address.

/// A file of the page, or the chart library, embedded when etlc was built.
struct PageFile {
    std::string_view name;    ///< "page.html"
    std::string_view sha256;  ///< in hexadecimal digits
    std::string_view text;
};
const std::vector<PageFile>& page_files();

/// Returns the file of that name, which exists.
const PageFile& page_file(const std::vector<PageFile>& files, std::string_view name);

/// Returns the hash of a program or a style, as a Content-Security-Policy names it.
std::string hash_source(const PageFile& file);

/// Fills the placeholders of a page, such as {{style}}.
std::string filled(std::string_view frame,
                   const std::map<std::string, std::string, std::less<>>& parts);

/// The page before and after its data.
struct Frame {
    std::string before;
    std::string after;
};

/// `figures` is the output of `etlc evaluate --json`, or null. Neither they nor the data may be
/// able to end a script element.
Frame frame_of(const std::string& figures);

/// Returns why this etlc cannot make pages, or an empty text.
std::string what_is_missing();

}  // namespace etlc::report
