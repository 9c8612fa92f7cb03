// The series of an episode as one text of the page, within a number of bytes.
// Takes: an episode's tracks. Gives: the text that report/page/episode.js unpacks: exact where that
// fits, else rounded, else the least and greatest of every so many steps. Keeps true: truths and
// verdicts are never reduced, so what the page says of them is what they were.
#pragma once

#include <cstdint>
#include <string>

#include "report/tracks.hpp"

namespace etlc::report {

struct Blob {
    std::string text;
    int parts = 0;              ///< of the span of a series, to which it is rounded; 0: exact
    std::uint64_t buckets = 0;  ///< of steps whose least and greatest number is kept; 0: all are
};

/// The first form that takes no more than `most` bytes, or the smallest.
Blob blob_of(const Tracks& tracks, std::uint64_t most);

}  // namespace etlc::report
