#include "judge.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>

#include "etlmon/checksum.hpp"

namespace etlc::faults {

namespace {

/// Returns the checksum of the targets file that a header requires: `using Targets =
/// etlmon::Targets<SIZE, 0x...>`.
std::uint64_t asked_for(const std::string& header) {
    const std::size_t targets = header.find("etlmon::Targets<");
    const std::size_t number = header.find("0x", targets);
    return targets == std::string::npos ? 0 : std::strtoull(header.c_str() + number, nullptr, 16);
}

std::uint64_t checksum(const std::string& targets) {
    etlmon::Checksum checksum;
    checksum.add(reinterpret_cast<const std::uint8_t*>(targets.data()), targets.size());
    return checksum.value();
}

bool is_targets(const std::string& name) {
    return name.ends_with(".targets.bin");
}

/// Returns whether the header accepts the targets file beside it.
bool fits(const Files& files) {
    const auto targets = std::find_if(files.begin(), files.end(),
                                      [](const auto& file) { return is_targets(file.first); });
    const auto header = std::find_if(files.begin(), files.end(),
                                     [](const auto& file) { return file.first.ends_with(".hpp"); });
    return targets == files.end() || header == files.end() ||
           asked_for(header->second) == checksum(targets->second);
}

/// Returns the defects of the files after a run. `between`: it may have ended between two renames.
std::string wrong_files(const Command& command, const Files& files, bool between) {
    for (const std::string& name : command.files) {
        const auto file = files.find(name);
        if (file == files.end()) return name + " is gone";
        if (file->second != command.before.at(name) && file->second != command.after.at(name))
            return name + " is damaged";
    }
    const bool mixed = files != command.before && files != command.after;
    if (mixed && !between) return "files of this call lie beside earlier ones";
    if (command.name == "compile" && mixed && fits(files) && asked_for(files.at("dock.hpp")) == 0)
        return "the header has no checksum";
    const bool both = files.contains("dock.hpp") && files.contains("dock.targets.bin");
    if (both &&
        fits(files) != ((files.at("dock.hpp") == command.after.at("dock.hpp")) ==
                        (files.at("dock.targets.bin") == command.after.at("dock.targets.bin"))))
        return "a header and targets of different calls fit, or those of one call do not";
    return "";
}

/// Returns whether writes to standard error may be among the failing ones.
bool cannot_speak(const Command& command, const Surroundings& around) {
    if (!around.injection.starts_with("write:")) return false;
    const bool only_one =
        around.injection.find(":1:", around.injection.find(':') + 1) != std::string::npos;
    return !only_one || command.undisturbed.status != 0;
}

/// Returns the defects of a run that ended by itself.
std::string wrong_ending(const Command& command, const Surroundings& around, const Outcome& outcome,
                         const Files& files) {
    const Outcome& undisturbed = command.undisturbed;
    const bool silent = around.error != Stream::open || cannot_speak(command, around);
    if (outcome.status != 0 && outcome.status != 1)
        return fmt::format("exit status {}", outcome.status);
    if (outcome.status == 0) {
        if (undisturbed.status != 0) return "a mistake goes by";
        if (files != command.after) return "exit status 0, and a file is not written";
        if (outcome.output != (around.output == Stream::open ? undisturbed.output : ""))
            return "standard output differs";
        if (around.output != Stream::open && !undisturbed.output.empty())
            return "standard output is lost";
        if (around.error == Stream::full && !undisturbed.error.empty())
            return "standard error is lost";
        if (!silent && outcome.error != undisturbed.error) return "standard error differs";
        return "";
    }
    if (!undisturbed.output.starts_with(outcome.output)) return "standard output is something else";
    // Diagnostics come last: if part of them is lost, the rest is done.
    const bool all_but_diagnostics =
        undisturbed.status == 0 && files == command.after && outcome.output == undisturbed.output;
    const bool lost_diagnostics = !undisturbed.error.empty() && outcome.error != undisturbed.error;
    if (!silent && outcome.error.empty() && !(all_but_diagnostics && lost_diagnostics))
        return "no message";
    if (!silent && !command.files.empty() && all_but_diagnostics && !lost_diagnostics)
        return "exit status 1, and the files are written";
    return "";
}

}  // namespace

void Judge::judge(const Scene& scene, const Command& command, const Surroundings& around,
                  const std::string& what, const Outcome& outcome) {
    ++runs_;
    const Files files = scene.written(command);
    const std::vector<std::string> left = scene.left_over(command);
    const auto find = [&](const std::string& finding) {
        findings_.push_back(fmt::format("{}, {}: {}; exit status {}, signal {}, said: {}",
                                        command.name, what, finding, outcome.status, outcome.signal,
                                        outcome.error));
    };
    const bool killed = around.killed_after && outcome.signal == SIGKILL;
    if (killed) ++killed_;
    if (outcome.signal != 0 && !killed) return find("ended by a signal");
    const bool between = killed || around.injection.starts_with("rename:");
    if (const std::string wrong = wrong_files(command, files, between); !wrong.empty())
        return find(wrong);
    if (killed) return;
    if (!left.empty()) return find("leaves " + left.front());
    if (const std::string wrong = wrong_ending(command, around, outcome, files); !wrong.empty())
        find(wrong);
}

void Judge::judge_pair(const Scene& scene, const Command& command, const Outcome& one,
                       const Outcome& other) {
    runs_ += 2;
    const Files files = scene.written(command);
    if (one.status != 0 || other.status != 0)
        findings_.push_back(fmt::format("two at the same time: {}{}", one.error, other.error));
    else if (!fits(files))
        findings_.push_back("two at the same time: mixed files");
    else if (!scene.left_over(command).empty())
        findings_.push_back("two at the same time: leave " + scene.left_over(command).front());
}

}  // namespace etlc::faults
