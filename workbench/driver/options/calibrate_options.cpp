#include "driver/options/calibrate_options.hpp"

#include "driver/fleet/options.hpp"
#include "driver/options/options.hpp"
#include "driver/options/recording_options.hpp"
#include "driver/options/spec_options.hpp"

namespace etlc::driver {

void add_calibrate_options(CLI::App& app, CalibrateRequest& calibrate) {
    calibrate::Request& calibration = calibrate.calibration;
    add_set_option(app, calibrate.settings);
    add_episode_options(app, calibrate.data, calibrate.groups, calibration.allow_overlap,
                        calibration.jobs);
    add_map_option(app, calibration.names);
    app.add_option("-o,--output", calibrate.output,
                   "where to write the thresholds (default: SPEC.thresholds.json beside the spec); "
                   "- is standard output")
        ->type_name("FILE");
    app.add_option("--thresholds", calibrate.thresholds,
                   "the thresholds of the predicates: then the monitors that are calibrated as a "
                   "whole are, on episodes that these thresholds have not seen")
        ->type_name("FILE");
    add_fitted_option(app, calibrate.fitted);
    add_embedded_option(app, calibrate.embedded);
    add_folds_option(app, calibration.folds,
                     "also say what the thresholds would be without each of N folds of the "
                     "episodes");
    add_shard_options(app, calibrate.shard);
}

}  // namespace etlc::driver
