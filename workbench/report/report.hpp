// `etlc report`: shows what a spec says of recorded episodes on one web page. The same data give
// the same bytes, and the figures are the text of `etlc evaluate --json`. The page keeps to the
// requested size if possible, and lists what it left out.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "compile.hpp"
#include "diag/diag.hpp"
#include "evaluate/evaluate.hpp"
#include "report/pictures.hpp"
#include "report/tracks.hpp"

namespace etlc::report {

/// The series of an episode in one text of the page, which report/page/episode.js unpacks.
struct Blob {
    std::string text;
    int parts = 0;              ///< a series is rounded to these parts of its span; 0: exact
    std::uint64_t buckets = 0;  ///< of steps, with their least and greatest; 0: all steps
};

std::string base64(std::string_view bytes);

/// Compresses to zlib's format (RFC 1950).
std::string deflated(std::string_view bytes);

inline constexpr std::uint64_t kUsualMegabytes = 5;

struct Request {
    std::vector<std::string> episodes;  ///< as recordings::find_episodes gives them
    episodes::ReadOptions reading;
    unsigned jobs = 0;                          ///< threads; 0: as many as the machine has
    std::uint64_t megabytes = kUsualMegabytes;  ///< requested size of the page
    FramesOption frames;
    plan::Limits limits;  ///< limits on the ground truth's plan
    /// Called occasionally, by any thread, never by two at once.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// The inputs of a report.
struct Material {
    const source::File& file;
    const Compiled& spec;
    /// The ground truth, and the comparison with it; null without truths.
    const evaluate::Subject* truth = nullptr;
    const evaluate::Judgement* judgement = nullptr;
    std::string why_no_truth;
    std::optional<thresholds::File> thresholds;  ///< if calibrated
};

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

/// A page, whose rows become text as it is written.
struct Page {
    std::string head;  ///< what comes before the rows
    std::vector<Row> rows;
    std::vector<evaluate::EpisodeRow> judged;
    std::string tail;  ///< what comes after the rows

    /// Passes the pieces to `take` until it returns false; returns whether it took all.
    bool write(const std::function<bool(std::string_view)>& take) const;
};

/// Returns the page, or nothing after an error, which it reports.
std::optional<Page> page(const Material& material, const Request& request, diag::Sink& sink);

/// Returns the timelines of one trace, without truths, as an SVG picture.
std::optional<std::string> picture(const Compiled& spec, const std::string& trace,
                                   const episodes::ReadOptions& reading, diag::Sink& sink);

}  // namespace etlc::report
