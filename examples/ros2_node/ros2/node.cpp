// The ROS 2 node around MonitorNode. Its executor is single-threaded, as MonitorNode requires.
#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/float32_multi_array.hpp>
#include <std_srvs/srv/trigger.hpp>

#include "monitor_node.hpp"

namespace {

using diagnostic_msgs::msg::DiagnosticArray;
using std_msgs::msg::Float32MultiArray;
using std_srvs::srv::Trigger;

class PatrolNode : public rclcpp::Node {
public:
    PatrolNode() : Node("patrol"), node_(declare_parameter<std::string>("incidents", ".")) {
        diagnostics_ = create_publisher<DiagnosticArray>("/diagnostics", 10);
        verdicts_ =
            create_publisher<DiagnosticArray>("~/verdicts", rclcpp::QoS(1).transient_local());
        embeddings_ = create_subscription<Float32MultiArray>(
            "embedding", rclcpp::SensorDataQoS(), [this](const Float32MultiArray& message) {
                node_.take(message.data.data(), message.data.size());
            });
        references_ = create_subscription<Float32MultiArray>(
            "reference_embeddings", rclcpp::QoS(1).transient_local(),
            [this](const Float32MultiArray& message) {
                node_.take_references(message.data.data(), message.data.size());
            });
        reset_ = create_service<Trigger>(
            "~/reset",
            [this](const Trigger::Request::SharedPtr, const Trigger::Response::SharedPtr response) {
                node_.reset();
                response->success = true;
            });
        timer_ = rclcpp::create_timer(this, get_clock(), patrol_node::kTick, [this] { tick(); });
    }

private:
    void tick() {
        const patrol_node::Report report = node_.tick();
        if (report.verdicts_changed) publish(*verdicts_, report.verdicts);
        if (report.verdicts_changed || ticks_++ % 10 == 0)
            publish(*diagnostics_, report.diagnostics);
    }

    void publish(rclcpp::Publisher<DiagnosticArray>& publisher,
                 const std::vector<patrol_node::Status>& statuses) {
        DiagnosticArray array;
        array.header.stamp = now();
        for (const patrol_node::Status& status : statuses) {
            auto& message = array.status.emplace_back();
            message.level = static_cast<std::uint8_t>(status.level);
            message.name = status.name;
            message.message = status.message;
            message.hardware_id = "patrol";
            for (const patrol_node::KeyValue& value : status.values) {
                auto& pair = message.values.emplace_back();
                pair.key = value.key;
                pair.value = value.value;
            }
        }
        publisher.publish(array);
    }

    patrol_node::MonitorNode node_;
    unsigned ticks_ = 0;
    rclcpp::Publisher<DiagnosticArray>::SharedPtr diagnostics_;
    rclcpp::Publisher<DiagnosticArray>::SharedPtr verdicts_;
    rclcpp::Subscription<Float32MultiArray>::SharedPtr embeddings_;
    rclcpp::Subscription<Float32MultiArray>::SharedPtr references_;
    rclcpp::Service<Trigger>::SharedPtr reset_;
    rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace

int main(int argc, char** argv) {
    rclcpp::init(argc, argv);
    rclcpp::spin(std::make_shared<PatrolNode>());
    rclcpp::shutdown();
    return 0;
}
