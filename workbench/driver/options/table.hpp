// What the parts of the table of options share: groups of commands, and values.
#pragma once

#include <vector>

#include "driver/options/option.hpp"

namespace etlc::driver {

inline constexpr Commands kExecute = Commands(Command::run) | Command::explain;
inline constexpr Commands kEvaluate = Commands(Command::evaluate) | Command::crossvalidate;
/// The commands that generate a class.
inline constexpr Commands kClass = Commands(Command::compile) | Command::prove;
/// The commands that plan monitors.
inline constexpr Commands kPlan =
    kExecute | kEvaluate | kClass | Command::incident | Command::report | Command::watch;
inline constexpr Commands kLearn = Commands(Command::fit) | Command::calibrate;
inline constexpr Commands kReadEpisodes = kLearn | kEvaluate | Command::report;
inline constexpr Commands kFindEpisodes = kReadEpisodes | Command::label;
inline constexpr Commands kReadRecordings =
    kFindEpisodes | kExecute | Command::embed | Command::watch;
inline constexpr Commands kReadSpec = kPlan | kLearn | Command::embed | Command::label;

inline constexpr auto kRequired = Option::Need::required;

inline Takes checked(Takes takes, std::string (*check)(const std::string&)) {
    takes.check = check;
    return takes;
}

inline Takes several(Takes takes) {
    takes.repeats = true;
    return takes;
}

inline Takes retargetable() {
    return flag(in(&Call::check, &check::Options::retargetable));
}

inline Takes lets() {
    return flag(in(&Call::check, &check::Options::lets));
}

/// The options of single commands.
std::vector<Option> own_options();

}  // namespace etlc::driver
