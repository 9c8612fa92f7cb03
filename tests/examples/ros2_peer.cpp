// ros2_peer: replaces the ROS 2 nodes around patrol_dds. Checks that an embedding on the wire is
// the CDR of ROS 2, publishes embeddings until diagnostics report an alarm, and prints the
// diagnostics of it and of an embedding of another size, and the messages for a late subscriber.
// The encoder that it shows, all zeros, is not that of calibration.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "ros_messages.h"

namespace {

using Embedding = std_msgs_msg_dds__Float32MultiArray_;
using DiagnosticArray = diagnostic_msgs_msg_dds__DiagnosticArray_;

constexpr int kMostRounds = 5000;  // of 50 ms; long, since a busy machine is slow

dds_entity_t checked(dds_return_t result, const char* what) {
    if (result >= 0) return result;
    std::fprintf(stderr, "%s: %s\n", what, dds_strretcode(-result));
    std::exit(1);
}

/// The defaults of rclcpp: reliable, the last ten; `latched`: also the last one for late
/// subscribers.
dds_qos_t* qos(bool latched) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_durability(qos, latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, latched ? 1 : 10);
    return qos;
}

class Peer {
public:
    Peer() : participant_(checked(dds_create_participant(domain(), nullptr, nullptr), "peer")) {}
    ~Peer() { dds_delete(participant_); }

    dds_entity_t writer(const dds_topic_descriptor_t& type, const char* name, bool latched) {
        return checked(dds_create_writer(participant_, topic(type, name), qos(latched), nullptr),
                       name);
    }
    dds_entity_t reader(const dds_topic_descriptor_t& type, const char* name, bool latched) {
        return checked(dds_create_reader(participant_, topic(type, name), qos(latched), nullptr),
                       name);
    }

private:
    static dds_domainid_t domain() {
        return static_cast<dds_domainid_t>(std::strtoul(std::getenv("ROS_DOMAIN_ID"), nullptr, 10));
    }
    dds_entity_t topic(const dds_topic_descriptor_t& type, const char* name) {
        return checked(dds_create_topic(participant_, &type, name, nullptr, nullptr), name);
    }
    dds_entity_t participant_;
};

void wait_a_little() {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

void publish(dds_entity_t writer, std::vector<float> elements) {
    static char label[] = "d";
    std_msgs_msg_dds__MultiArrayDimension_ dimension{label, 4, 4};
    Embedding message{};
    message.layout.dim._buffer = &dimension;
    message.layout.dim._length = message.layout.dim._maximum = 1;
    message.data._buffer = elements.data();
    message.data._length = message.data._maximum = static_cast<std::uint32_t>(elements.size());
    checked(dds_write(writer, &message), "write");
}

/// {layout: {dim: [{label: "d", size: 4, stride: 4}], data_offset: 0}, data: [0, 0, 1, 0]} in CDR:
/// little-endian, each number at a multiple of its size, a string with its length and its zero.
const std::uint8_t kOnWire[] = {0, 1, 0, 0,                            // CDR_LE
                                1, 0, 0, 0, 2, 0, 0, 0, 'd', 0, 0, 0,  // dim: 1, "d"
                                4, 0, 0, 0, 4, 0, 0, 0, 0,   0, 0, 0,  // and its numbers
                                4, 0, 0, 0, 0, 0, 0, 0, 0,   0, 0, 0, 0, 0, 128, 63, 0, 0, 0, 0};

bool is_cdr_of_ros(dds_entity_t reader) {
    for (int round = 0; round < kMostRounds; ++round, wait_a_little()) {
        ddsi_serdata* data = nullptr;
        dds_sample_info_t info;
        if (checked(dds_takecdr(reader, &data, 1, &info, DDS_ANY_STATE), "takecdr") == 0) continue;
        std::vector<std::uint8_t> bytes(ddsi_serdata_size(data));
        ddsi_serdata_to_ser(data, 0, bytes.size(), bytes.data());
        ddsi_serdata_unref(data);
        return bytes.size() == sizeof kOnWire &&
               std::memcmp(bytes.data(), kOnWire, sizeof kOnWire) == 0;
    }
    return false;
}

/// Returns the text of the status with that name in the received messages; empty if there is none.
std::string said(dds_entity_t reader, const std::string& name) {
    std::string found;
    for (;;) {
        void* samples[1] = {};
        dds_sample_info_t infos[1];
        if (checked(dds_take(reader, samples, infos, 1, 1), "take") == 0) return found;
        const auto& array = *static_cast<const DiagnosticArray*>(samples[0]);
        for (std::uint32_t i = 0; infos[0].valid_data && i < array.status._length; ++i) {
            const auto& status = array.status._buffer[i];
            if (status.name == name) found = std::to_string(status.level) + " " + status.message;
        }
        dds_return_loan(reader, samples, 1);
    }
}

/// Publishes until a status has this level and text; returns false if it never does.
bool publish_until(dds_entity_t writer, const std::vector<float>& elements, dds_entity_t reader,
                   const std::string& name, const std::string& words) {
    for (int round = 0; round < kMostRounds; ++round, wait_a_little()) {
        publish(writer, elements);
        if (said(reader, name) == words) return true;
    }
    std::fprintf(stderr, "'%s' never said '%s'\n", name.c_str(), words.c_str());
    return false;
}

}  // namespace

int main() {
    Peer peer;
    const auto& array = diagnostic_msgs_msg_dds__DiagnosticArray__desc;
    const auto& embedding = std_msgs_msg_dds__Float32MultiArray__desc;
    const dds_entity_t own = peer.reader(embedding, "rt/embedding", false);
    const dds_entity_t writer = peer.writer(embedding, "rt/embedding", false);
    const dds_entity_t references = peer.writer(embedding, "rt/reference_embeddings", true);
    const dds_entity_t diagnostics = peer.reader(array, "rt/diagnostics", false);
    publish(writer, {0, 0, 1, 0});
    publish(references, std::vector<float>(16));  // the node may come later
    if (!is_cdr_of_ros(own)) return std::fputs("this is no CDR of ROS 2\n", stderr), 1;
    if (!publish_until(writer, {0, 0, 1, 0}, diagnostics, "patrol: gives_way",
                       "2 violated for good") ||
        !publish_until(writer, {0, 0, 1, 0}, diagnostics, "patrol: encoder",
                       "2 is not the one of calibration: verdicts mean nothing") ||
        !publish_until(writer, {0, 0, 1}, diagnostics, "patrol: embeddings",
                       "2 one has 3 elements, expected 4"))
        return 1;
    Peer late;
    const dds_entity_t verdicts = late.reader(array, "rt/patrol/verdicts", true);
    for (int round = 0; round < kMostRounds; ++round, wait_a_little()) {
        const std::string words = said(verdicts, "patrol: gives_way");
        if (words.empty()) continue;
        std::printf("a late subscriber gets: %s\n", words.c_str());
        return words == "2 violated for good" ? 0 : 1;
    }
    return std::fputs("a late subscriber gets nothing\n", stderr), 1;
}
