// Episodes in memory, for tests of calibration.
// Takes: the text of a .csv file. Gives: what opens it as an episode. Keeps true: nothing is
// written to disk.
#pragma once

#include <string>

#include "calibrate/episodes/recording.hpp"

namespace etlc::tests {

/// Opens this text as a .csv episode; it is copied.
calibrate::Opener csv_episode(std::string text);

/// "y n ? y": the labels of a predicate, frame after frame; the failure's message where there was
/// one.
std::string labels(const calibrate::Wanted& wanted, const calibrate::Opener& open,
                   calibrate::Index predicate);

}  // namespace etlc::tests
