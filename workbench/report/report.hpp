// `etlc report`: shows what a spec says of recorded episodes on one web page. The same data give
// the same bytes, and the figures are the text of `etlc evaluate --json`. The page keeps to the
// requested size if possible, and lists what it left out.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "data/recordings/open.hpp"
#include "diag/diag.hpp"
#include "evaluate/evaluate.hpp"
#include "pipeline/compile.hpp"
#include "report/pictures.hpp"

namespace etlc::report {

inline constexpr std::uint64_t kUsualMegabytes = 5;

struct Request {
    std::vector<std::string> episodes;  ///< as data::find_episodes gives them
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
    const pipeline::Compiled& spec;
    /// The ground truth, and the comparison with it; null without truths.
    const evaluate::Subject* truth = nullptr;
    const evaluate::Judgement* judgement = nullptr;
    std::string why_no_truth;
    std::optional<thresholds::File> thresholds;  ///< if calibrated
};

/// Returns the page, or nothing after an error, which it reports.
std::optional<std::string> page(const Material& material, const Request& request, diag::Sink& sink);

/// Returns the timelines of one trace, without truths, as an SVG picture.
std::optional<std::string> picture(const pipeline::Compiled& spec, const std::string& trace,
                                   const episodes::ReadOptions& reading, diag::Sink& sink);

}  // namespace etlc::report
