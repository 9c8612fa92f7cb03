// The files of incidents: the steps around each alarm, as the flight recorder of a generated class
// writes them.
// Keeps true: an alarm is in a file before anybody reads of it, with the steps before; the steps
// behind it follow. No earlier file is replaced.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "execute/flight_recorder.hpp"

namespace etlc::watch {

class Incidents {
public:
    /// `plan`: with a recorder. `folder`: it exists.
    Incidents(const plan::Plan& plan, std::string folder);

    /// Records a step, and writes the incidents that it begins or completes. Returns why they
    /// cannot be written; the next step tries again.
    std::optional<diag::Diagnostic> step(const execute::Evaluator& evaluator,
                                         const std::vector<etlmon::Verdict>& verdicts);
    /// Writes those that wait for more steps as they are.
    std::optional<diag::Diagnostic> close();

    /// Returns "3 incidents in FOLDER".
    std::string text() const;

private:
    std::string path(std::uint64_t number) const;
    std::optional<diag::Diagnostic> write(execute::FlightRecorder& recorder,
                                          std::uint32_t incident);
    bool begins(const std::vector<etlmon::Verdict>& verdicts);
    std::optional<diag::Diagnostic> write_complete();

    const plan::Plan& plan_;
    std::string folder_;
    execute::FlightRecorder recorder_;
    std::vector<bool> alarms_;   ///< per monitor: at the last step
    bool is_noted_ = true;       ///< all incidents so far have a file
    std::uint32_t begun_ = 0;    ///< in the recorder
    std::uint32_t written_ = 0;  ///< of these, complete and in their files
    std::vector<std::uint64_t>
        numbers_;               ///< of those in the recorder that have a file, in its name
    std::uint64_t next_ = 0;    ///< number of the next one, unless another call takes it
    std::uint64_t before_ = 0;  ///< complete ones before this filling of the recorder
    std::uint64_t lost_ = 0;    ///< alarms that had no room, before this filling
};

}  // namespace etlc::watch
