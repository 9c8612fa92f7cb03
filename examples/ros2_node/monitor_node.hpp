// The logic of the node, without types of ROS.
// Takes: embeddings as they arrive, and ticks at the rate of the spec. Gives: the statuses to
// publish at each tick. Keeps true: a tick is one step of the monitors, with the newest embedding
// since the previous tick or with none; an embedding is used once. One thread at a time.
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

/// The dimension of input z.
inline constexpr std::size_t kDimension = 4;
/// The period of the spec's rate.
inline constexpr std::chrono::milliseconds kTick{100};

/// The fields of diagnostic_msgs/DiagnosticStatus.
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

/// The result of a tick.
struct Report {
    std::vector<Status> diagnostics;  ///< of encoder, embeddings, incidents, each monitor
    std::vector<Status> verdicts;     ///< of each monitor
    bool verdicts_changed = false;    ///< whether a verdict differs from the previous tick
};

class MonitorNode {
public:
    /// Writes incidents to files in this folder.
    explicit MonitorNode(std::string incident_folder) : files_(std::move(incident_folder)) {}

    /// Takes an embedding. Refuses and counts one of another size.
    void take(const float* elements, std::size_t count);

    /// Takes the embeddings of the reference frames, one after the other, as the robot's encoder
    /// makes them. Refuses another number of elements.
    void take_references(const float* elements, std::size_t count);

    Report tick();

    /// Begins a new episode: another patrol.
    void reset();

private:
    Status status_of_embeddings() const;
    const Status& status_of_encoder() const { return encoder_; }
    Status status_of_incidents() const;
    std::vector<Status> judge(bool& changed);

    patrol::Monitor monitor_;
    patrol::Verdicts verdicts_;
    std::array<float, kDimension> newest_{};
    bool is_new_ = false;
    std::uint64_t ticks_without_ = 0;  ///< in a row
    std::uint64_t taken_ = 0;
    std::uint64_t replaced_ = 0;  ///< replaced by a newer one before a tick
    std::uint64_t refused_ = 0;
    std::size_t refused_size_ = 0;  ///< size of the last refused one; 0: the last one was accepted
    std::vector<std::uint32_t> answers_;
    Status encoder_{Level::warn, "patrol: encoder", "has not shown its reference embeddings", {}};
    IncidentFiles files_;
};

}  // namespace patrol_node
