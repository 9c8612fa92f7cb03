// Packs the series of an episode into one text of the page, within a number of bytes, which
// report/page/episode.js unpacks: exact if that fits, else rounded, else reduced to the least and
// greatest numbers of buckets of steps. Truths and verdicts are never reduced.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "report/tracks.hpp"

namespace etlc::report {

struct Blob {
    std::string text;
    int parts = 0;              ///< a series is rounded to these parts of its span; 0: exact
    std::uint64_t buckets = 0;  ///< of steps, with their least and greatest; 0: all steps
};

std::string base64(std::string_view bytes);

/// Compresses to zlib's format (RFC 1950).
std::string deflated(std::string_view bytes);

/// Returns the first form of at most `most` bytes, or the smallest.
Blob blob_of(const Tracks& tracks, std::uint64_t most);

}  // namespace etlc::report
