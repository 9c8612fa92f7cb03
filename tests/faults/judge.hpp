// What etlc must do, whatever happens to it.
// Keeps true, of every run:
// - it ends by a signal only where it was sent SIGKILL;
// - exit status 0 means that all outputs are there, complete and as ever; otherwise it is 1, with a
//   message;
// - a file is as it was or as it is to be; where the process could end by itself, all of them are
//   as they were, or all as they are to be and only diagnostics were lost;
// - no temporary file stays, except where names changed hands when the process was killed;
// - a header and a file of targets of different calls do not fit.
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
    long left_by_kills() const { return left_by_kills_; }

private:
    std::vector<std::string> findings_;
    long runs_ = 0;
    long killed_ = 0;
    long left_by_kills_ = 0;
};

}  // namespace etlc::faults
