// `etlc report`: what a spec makes of recorded episodes, as one web page to look at.
// Takes: a compiled spec, its judgement where truths are known, and the episodes. Gives: the page's
// text. Keeps true: the same data give the same bytes; the figures are those of `etlc evaluate
// --json`, letter for letter; the page has no more bytes than asked for where that is possible, and
// says what was left out for it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data/recordings/open.hpp"
#include "diag/diag.hpp"
#include "evaluate/evaluate.hpp"
#include "pipeline/compile.hpp"
#include "report/pictures/pictures.hpp"
#include "thresholds/thresholds.hpp"

namespace etlc::report {

inline constexpr std::uint64_t kUsualMegabytes = 5;

struct Request {
    std::vector<std::string> episodes;  ///< as data::find_episodes gives them
    data::NamesInFile names;
    unsigned jobs = 0;                          ///< threads; 0: as many as the machine has
    std::uint64_t megabytes = kUsualMegabytes;  ///< the size of the page
    FramesOption frames;
    plan::Limits limits;  ///< of the ground truth's plan
    /// Called now and then, by any thread, never by two at once.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// A spec, and what is known about it.
struct Material {
    const source::File& file;
    const pipeline::Compiled& spec;
    /// What it is held to, and what came of that; null: no truths are known.
    const evaluate::Subject* truth = nullptr;
    const evaluate::Judgement* judgement = nullptr;
    std::string why_no_truth;
    std::optional<thresholds::File> thresholds;  ///< where they were calibrated
};

/// Nothing where the sink now says why.
std::optional<std::string> page(const Material& material, const Request& request, diag::Sink& sink);

/// The timelines of one trace, without truths, as an SVG picture.
std::optional<std::string> picture(const pipeline::Compiled& spec, const std::string& trace,
                                   const data::NamesInFile& names, diag::Sink& sink);

}  // namespace etlc::report
