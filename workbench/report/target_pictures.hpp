// How the rows of targets look that are made of images, or of frames of a video.
// Takes: the predicates that are drawn. Gives: of each target from which one of them measures, a
// small picture a row. Keeps true: they take no more bytes than allowed, rows without room have
// none; where an image cannot be decoded any more, its target has none, with a warning: the
// verdicts rest on the embeddings, which are there.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"

namespace etlc::report {

/// By declared target: of each row a data: address, or an empty text.
using TargetPictures = std::map<check::Index, std::vector<std::string>>;

TargetPictures pictures_of_targets(const check::Model& model,
                                   const std::vector<check::Index>& predicates,
                                   std::uint64_t most_bytes, diag::Sink& sink);

}  // namespace etlc::report
