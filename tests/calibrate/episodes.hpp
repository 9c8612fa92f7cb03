// Episodes in memory, for tests of calibration.
// Takes: the text of a .csv file. Gives: what opens it as an episode. Keeps true: nothing is
// written to disk.
#pragma once

#include <string>

#include "episodes/recording.hpp"

namespace etlc::tests {

/// Opens this text as a .csv episode; it is copied.
episodes::Opener csv_episode(std::string text);

/// "y n ? y": the labels of a predicate, frame after frame; the failure's message where there was
/// one.
std::string labels(const episodes::Wanted& wanted, const episodes::Opener& open,
                   episodes::Index predicate);

}  // namespace etlc::tests
