#include "driver/compile/depfile.hpp"

#include <fmt/format.h>

#include "data/text/quote.hpp"
#include "source/escape.hpp"

namespace etlc::driver {

namespace {

diag::Failure unreadable(const std::string& path) {
    return {diag::Code::unwritable_output,
            fmt::format(
                "cannot name {}: make and ninja do not both read that name, however it is written",
                data::in_quotes(path))};
}

}  // namespace

diag::Result<std::string> dependency_rule(const std::string& output, const std::string& spec,
                                          const std::vector<std::string>& files) {
    const auto target = source::depfile_path(output, source::InRule::target);
    if (!target) return unreadable(output);
    std::string rule = *target + ":";
    std::vector<std::string> prerequisites = files;
    prerequisites.insert(prerequisites.begin(), spec);
    for (const std::string& file : prerequisites) {
        const auto path = source::depfile_path(file, source::InRule::prerequisite);
        if (!path) return unreadable(file);
        rule += (&file == prerequisites.data() ? " " : " \\\n  ") + *path;
    }
    return rule + "\n";
}

}  // namespace etlc::driver
