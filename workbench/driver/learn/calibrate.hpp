// `etlc calibrate`: spec and demonstrations in, thresholds file out.
// Takes: the spec's text. Gives: the file, and a report on standard output, or on standard error
// where the file goes to standard output. Keeps true: the file appears whole or not at all.
#pragma once

#include <string>
#include <vector>

#include "calibrate/calibrate.hpp"
#include "check/check.hpp"
#include "diag/diag.hpp"
#include "driver/fleet/fleet.hpp"
#include "source/source.hpp"

namespace etlc::driver {

struct CalibrateRequest {
    std::vector<std::string> data;   ///< files, folders and patterns
    std::string groups;              ///< of .h5 files that are episodes
    calibrate::Request calibration;  ///< its episodes, version and progress are set here
    std::string output;              ///< empty: beside the spec
    std::vector<check::Setting> settings;
    std::string fitted;      ///< the file of what is fitted; empty: beside the spec
    std::string embedded;    ///< the file of embeddings; empty: beside the spec
    std::string thresholds;  ///< those of the predicates; empty: they are calibrated now
    ShardRequest shard;
};

/// False where the sink now says why not.
bool calibrate(const source::File& file, const CalibrateRequest& request, diag::Sink& sink);

}  // namespace etlc::driver
