#include "driver/options/report_options.hpp"

#include "driver/options/options.hpp"
#include "driver/options/recording_options.hpp"

namespace etlc::driver {

void add_report_options(CLI::App& app, ReportRequest& report) {
    add_episode_options(app, report.data, report.groups, report.allow_overlap, report.report.jobs);
    add_map_option(app, report.report.names);
    app.add_option("--frames", report.report.frames.text,
                   "what the camera saw: an array of the episodes (T x H x W x 3 uint8), or a "
                   "pattern of PNG or JPEG files, one a step, or of videos, in which {episode} "
                   "stands for the episode's name: 'camera/{episode}/*.png'")
        ->type_name("ARRAY|PATTERN");
    add_number(app, "--size", report.report.megabytes,
               "the size of the page; what does not fit is left out, best episodes first, and the "
               "page says so",
               1, 1000)
        ->type_name("MB")
        ->default_str(std::to_string(report::kUsualMegabytes));
    app.add_flag("--no-truths", report.without_truths,
                 "show what the monitors say, and compare it with nothing");
    app.add_option("-o,--output", report.output, "the page, an .html file")
        ->type_name("FILE")
        ->required();
}

}  // namespace etlc::driver
