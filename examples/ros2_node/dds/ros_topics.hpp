// The topics of the node over DDS without ROS, in place of rclcpp, for a system with CycloneDDS
// only. ROS 2 nodes of the same domain see them as /embedding, /reference_embeddings, /diagnostics
// and /patrol/verdicts.
// Takes: a domain. Gives: received embeddings, and publishes statuses. Keeps true: a call of DDS
// that fails throws its message.
#pragma once

#include <dds/dds.h>

#include <functional>
#include <vector>

#include "monitor_node.hpp"

namespace patrol_node {

class RosTopics {
public:
    explicit RosTopics(std::uint32_t domain);
    ~RosTopics() { dds_delete(participant_); }
    RosTopics(const RosTopics&) = delete;
    RosTopics& operator=(const RosTopics&) = delete;

    using Each = std::function<void(const float* elements, std::size_t count)>;
    /// Passes on every embedding since the last call, the oldest first.
    void take(const Each& each) { take(embeddings_, each); }
    /// Passes on the embeddings of the reference frames in the same way, all in one message.
    void take_references(const Each& each) { take(references_, each); }

    void publish_diagnostics(const std::vector<Status>& statuses);
    /// A late subscriber gets the last ones too.
    void publish_verdicts(const std::vector<Status>& statuses);

private:
    static void take(dds_entity_t reader, const Each& each);

    dds_entity_t participant_;
    dds_entity_t embeddings_;
    dds_entity_t references_;
    dds_entity_t diagnostics_;
    dds_entity_t verdicts_;
};

}  // namespace patrol_node
