// Checks what etlc must do under every fault:
// - it ends by a signal only if it was sent SIGKILL;
// - exit status 0 means that all outputs exist, complete and correct; otherwise it is 1, with a
//   message;
// - each file is old or new; if the process ended by itself, all files are old, or all are new and
//   only diagnostics were lost, except where it cannot rename one file after another;
// - no temporary file remains, unless the process was killed;
// - a header and a targets file of different calls do not match.
#pragma once

#include <string>
#include <vector>

#include "scene.hpp"

namespace etlc::faults {

class Judge {
public:
    void judge(const Scene& scene, const Command& command, const Surroundings& around,
               const std::string& what, const Outcome& outcome);
    void judge_pair(const Scene& scene, const Command& command, const Outcome& one,
                    const Outcome& other);

    const std::vector<std::string>& findings() const { return findings_; }
    long runs() const { return runs_; }
    long killed() const { return killed_; }

private:
    std::vector<std::string> findings_;
    long runs_ = 0;
    long killed_ = 0;
};

}  // namespace etlc::faults
