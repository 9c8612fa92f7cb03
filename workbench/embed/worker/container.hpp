// Whether a video file is as long as it says.
// Takes: a file. Gives: why it is cut, where its first bytes say how long it is (Matroska, WebM) or
// what its last are (GIF); what other containers promise is counted in frames. Keeps true: a file
// of another kind, or one that says nothing, is not judged.
#pragma once

#include <string>

namespace etlc::embed::worker {

/// "" where nothing says that it is.
std::string why_cut(const std::string& path);

}  // namespace etlc::embed::worker
