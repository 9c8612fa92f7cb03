#include "ros_topics.hpp"

#include <stdexcept>
#include <string>

#include "ros_messages.h"

namespace patrol_node {

namespace {

using Embedding = std_msgs_msg_dds__Float32MultiArray_;
using DiagnosticArray = diagnostic_msgs_msg_dds__DiagnosticArray_;
using DiagnosticStatus = diagnostic_msgs_msg_dds__DiagnosticStatus_;
using DdsKeyValue = diagnostic_msgs_msg_dds__KeyValue_;

dds_entity_t checked(dds_return_t result, const char* what) {
    if (result >= 0) return result;
    throw std::runtime_error(std::string("DDS: ") + what + ": " + dds_strretcode(-result));
}

/// The QoS profiles of ROS 2: reliable or sensor data, and the number of samples kept.
class Qos {
public:
    Qos(dds_reliability_kind reliability, dds_durability_kind durability, int depth)
        : qos_(dds_create_qos()) {
        dds_qset_reliability(qos_, reliability, DDS_SECS(1));
        dds_qset_durability(qos_, durability);
        dds_qset_history(qos_, DDS_HISTORY_KEEP_LAST, depth);
    }
    ~Qos() { dds_delete_qos(qos_); }
    Qos(const Qos&) = delete;
    Qos& operator=(const Qos&) = delete;
    operator const dds_qos_t*() const { return qos_; }

private:
    dds_qos_t* qos_;
};

/// DDS only reads these strings, although they are not pointers to const.
char* text(const std::string& words) {
    return const_cast<char*>(words.c_str());
}

DiagnosticStatus message_of(const Status& status, std::vector<DdsKeyValue>& values) {
    for (const KeyValue& value : status.values)
        values.push_back({text(value.key), text(value.value)});
    DiagnosticStatus message{};
    static const std::string hardware = "patrol";
    message.level = static_cast<std::uint8_t>(status.level);
    message.name = text(status.name);
    message.message = text(status.message);
    message.hardware_id = text(hardware);
    message.values._buffer = values.data();
    message.values._length = message.values._maximum = static_cast<std::uint32_t>(values.size());
    return message;
}

void write(dds_entity_t writer, const std::vector<Status>& statuses) {
    const std::string frame;
    std::vector<std::vector<DdsKeyValue>> values(statuses.size());
    std::vector<DiagnosticStatus> messages;
    for (std::size_t i = 0; i < statuses.size(); ++i)
        messages.push_back(message_of(statuses[i], values[i]));
    DiagnosticArray array{};
    const dds_time_t now = dds_time();  // since 1970
    array.header.stamp.sec = static_cast<std::int32_t>(now / DDS_NSECS_IN_SEC);
    array.header.stamp.nanosec = static_cast<std::uint32_t>(now % DDS_NSECS_IN_SEC);
    array.header.frame_id = text(frame);
    array.status._buffer = messages.data();
    array.status._length = array.status._maximum = static_cast<std::uint32_t>(messages.size());
    checked(dds_write(writer, &array), "a message is not written");
}

}  // namespace

RosTopics::RosTopics(std::uint32_t domain)
    : participant_(checked(dds_create_participant(domain, nullptr, nullptr), "no participant")) {
    const auto topic = [&](const dds_topic_descriptor_t& type, const char* name) {
        return checked(dds_create_topic(participant_, &type, name, nullptr, nullptr), name);
    };
    const auto writer = [&](const char* name, const Qos& qos) {
        const dds_entity_t of = topic(diagnostic_msgs_msg_dds__DiagnosticArray__desc, name);
        return checked(dds_create_writer(participant_, of, qos, nullptr), name);
    };
    // A best-effort reader accepts reliable writers too.
    const Qos sensor(DDS_RELIABILITY_BEST_EFFORT, DDS_DURABILITY_VOLATILE, 10);
    const Qos latched(DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_TRANSIENT_LOCAL, 1);
    const auto reader = [&](const char* name, const Qos& qos) {
        const dds_entity_t of = topic(std_msgs_msg_dds__Float32MultiArray__desc, name);
        return checked(dds_create_reader(participant_, of, qos, nullptr), name);
    };
    embeddings_ = reader("rt/embedding", sensor);
    references_ = reader("rt/reference_embeddings", latched);
    diagnostics_ =
        writer("rt/diagnostics", Qos(DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_VOLATILE, 10));
    verdicts_ = writer("rt/patrol/verdicts", latched);
}

void RosTopics::take(dds_entity_t reader, const Each& each) {
    constexpr std::size_t kMost = 10;
    for (;;) {
        void* samples[kMost] = {};  // lent by DDS
        dds_sample_info_t infos[kMost];
        const int count = checked(dds_take(reader, samples, infos, kMost, kMost), "take");
        if (count == 0) return;
        for (int i = 0; i < count; ++i) {
            if (!infos[i].valid_data) continue;  // a publisher left
            const auto& data = static_cast<const Embedding*>(samples[i])->data;
            each(data._buffer, data._length);
        }
        checked(dds_return_loan(reader, samples, count), "return_loan");
    }
}

void RosTopics::publish_diagnostics(const std::vector<Status>& statuses) {
    write(diagnostics_, statuses);
}

void RosTopics::publish_verdicts(const std::vector<Status>& statuses) {
    write(verdicts_, statuses);
}

}  // namespace patrol_node
