// Episodes in memory, for tests of calibration.
// Takes: the text of a .csv file. Gives: a function that opens it as an episode. Keeps true:
// nothing is written to disk.
#pragma once

#include <string>

#include "episodes/recording.hpp"

namespace etlc::tests {

/// Opens a copy of this text as a .csv episode.
episodes::Opener csv_episode(std::string text);

/// Returns the labels of a predicate, frame by frame, as "y n ? y", or the message of the failure.
std::string labels(const episodes::Wanted& wanted, const episodes::Opener& open,
                   episodes::Index predicate);

}  // namespace etlc::tests
