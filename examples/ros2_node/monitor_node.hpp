// What the node does, in no types of ROS.
// Takes: embeddings whenever one comes, and a tick at the rate of the spec. Gives: at each tick
// what to publish. Keeps true: a tick is one step of the monitors, with the newest embedding since
// the tick before it or with none; an embedding is used once. One thread at a time.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "incident_files.hpp"
#include "patrol.hpp"

namespace patrol_node {

/// Of the input z.
inline constexpr std::size_t kDimension = 4;
/// Of the spec's rate.
inline constexpr std::chrono::milliseconds kTick{100};

/// As diagnostic_msgs/DiagnosticStatus has them.
enum class Level : std::uint8_t { ok = 0, warn = 1, error = 2, stale = 3 };

struct KeyValue {
    std::string key;
    std::string value;
};

struct Status {
    Level level = Level::ok;
    std::string name;
    std::string message;
    std::vector<KeyValue> values;
};

/// What a tick gives.
struct Report {
    std::vector<Status> diagnostics;  ///< of the embeddings, of the incidents, of each monitor
    std::vector<Status> verdicts;     ///< of each monitor
    bool verdicts_changed = false;    ///< an answer is another one than at the tick before
};

class MonitorNode {
public:
    /// Incidents go to files of this folder.
    explicit MonitorNode(std::string incident_folder) : files_(std::move(incident_folder)) {}

    /// An embedding. One of another size is refused, and counted.
    void take(const float* elements, std::size_t count);

    Report tick();

    /// A new episode: the robot begins another patrol.
    void reset();

private:
    Status status_of_embeddings() const;
    Status status_of_incidents() const;
    std::vector<Status> judge(bool& changed);

    patrol::Monitor monitor_;
    patrol::Verdicts verdicts_;
    std::array<float, kDimension> newest_{};
    bool is_new_ = false;
    std::uint64_t ticks_without_ = 0;  ///< in a row
    std::uint64_t taken_ = 0;
    std::uint64_t replaced_ = 0;  ///< by a newer one, before a tick
    std::uint64_t refused_ = 0;
    std::size_t refused_size_ = 0;  ///< of the last one; 0: the last one was taken
    std::vector<std::uint32_t> answers_;
    IncidentFiles files_;
};

}  // namespace patrol_node
