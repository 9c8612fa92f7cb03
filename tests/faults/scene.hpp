// The commands that the campaign disturbs, each in a folder with all its inputs.
// Keeps true: before a run the output files hold the results of an earlier spec, so that a lost or
// mixed output shows.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "process.hpp"

namespace etlc::faults {

using Files = std::map<std::string, std::string>;  ///< content by name

struct Command {
    std::string name;
    std::vector<std::string> words;  ///< after etlc
    std::vector<std::string> files;  ///< the outputs
    Files before{};
    Files after{};
    Outcome undisturbed{};
    std::map<std::string, long> calls{};  ///< counts of an undisturbed run, by the names of
                                          ///< inject.cpp
};

class Scene {
public:
    /// `data`: the folder of tests/unit/data.
    Scene(std::string etlc, const std::filesystem::path& data);
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
    ~Scene();

    const std::vector<Command>& commands() const { return commands_; }
    /// Restores the files from before the call.
    void restore(const Command& command) const;
    Process start(const Command& command, const Surroundings& around) const;
    Outcome run(const Command& command, const Surroundings& around) const;
    /// Returns the existing output files.
    Files written(const Command& command) const;
    /// Returns unexpected files.
    std::vector<std::string> left_over(const Command& command) const;
    std::filesystem::path path(const std::string& name) const { return folder_ / name; }
    /// The name of the earlier version of the first command's spec.
    std::string write_earlier_spec();

private:
    void write_specs(bool now) const;
    void write_inputs(const std::filesystem::path& data) const;
    void learn();

    std::string etlc_;
    std::filesystem::path folder_;
    std::filesystem::path counts_;
    std::vector<std::string> inputs_;
    std::vector<Command> commands_;
};

std::string read_text(const std::filesystem::path& path);

}  // namespace etlc::faults
