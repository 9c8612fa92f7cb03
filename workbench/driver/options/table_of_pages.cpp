// The options of etlc report and etlc label.
#include <string>
#include <vector>

#include "driver/options/tables.hpp"

namespace etlc::driver {

namespace {

Takes frames() {
    return text("ARRAY|PATTERN",
                in(&Call::report, &Call::Report::frames, &report::FramesOption::text));
}

Takes page_size() {
    return number<std::uint64_t>(in(&Call::report, &Call::Report::megabytes), 1, 1000,
                                 std::to_string(report::kUsualMegabytes), "MB");
}

Takes label_table() {
    return form("FILE", [](Call& call, const Takes::Words& words) {
        return call.labels.tables = words, std::string();
    });
}

}  // namespace

std::vector<Option> options_of_pages() {
    using enum Command;
    constexpr auto kRequired = Option::Need::required;
    return {
        // etlc report
        {Commands(report) | label, "--frames", frames(),
         "camera frames: an array of the episodes (T x H x W x 3 uint8), or a pattern of PNG or "
         "JPEG files, one a step, or of videos, in which {episode} stands for the episode's name: "
         "'camera/{episode}/*.png'"},
        {report, "--size", page_size(),
         "size of the page; what does not fit is left out, starting with the best episodes, and "
         "the page says so"},
        {report, "--no-truths", flag(in(&Call::report, &Call::Report::without_truths)),
         "show the verdicts without comparing them with truths"},
        {report, "-o,--output", file(in(&Call::output)), "the page, an .html file", kRequired},

        // etlc label
        {label, "--labels", label_table(),
         "table of labels to write, a .csv file (default: labels.csv beside the episodes)"},
        {label, "--camera", text("NAME", in(&Call::label, &Call::Label::camera)),
         "the camera of a data set whose folder --frames names, or that holds the episodes"},
        {label, "--port", number<std::uint32_t>(in(&Call::label, &Call::Label::port), 1, 65535),
         "port of the page (default: any free one)"},
        {label, "--proposals", flag(in(&Call::label, &Call::Label::proposals)),
         "print as JSON what the labelled episodes propose for the others, and serve no page"},
    };
}

}  // namespace etlc::driver
