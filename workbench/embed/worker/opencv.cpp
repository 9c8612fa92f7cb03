// Networks through OpenCV's dnn.
#include <algorithm>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>

#include "data/frames/protocol.hpp"
#include "embed/worker/network.hpp"
#include "embed/worker/prepare.hpp"
#include "embed/worker/worker.hpp"

namespace etlc::embed::worker {

namespace {

using data::frames::kRefused;

/// Of an exception the node and the reason: "Node [Expand@ai.onnx]:(name): Unsupported operations".
std::string what_failed(const cv::Exception& error) {
    const std::string text = error.what();
    const auto between = [&text](std::string_view begin, std::string_view end, std::size_t from) {
        const std::size_t at = text.find(begin, from);
        return at == std::string::npos ? "" : text.substr(at, text.find(end, at) - at);
    };
    const std::string node = between("Node [", " parse error", 0);
    const std::size_t reason = node.empty() ? 0 : text.find(node);
    std::string why = between("error: (", " in function", reason);
    why = why.substr(std::min(why.find(") ") + 2, why.size()));
    std::replace(why.begin(), why.end(), '\n', ' ');
    return node + (node.empty() || why.empty() ? "" : ": ") + why;
}

std::string way_out() {
    if constexpr (kHasOnnxRuntime)
        return "; run it by ONNX Runtime instead, --runtime onnxruntime, or by a command of your "
               "own: --encoder-cmd (docs/encoders.md)";
    return "; run the model by a command of your own instead: --encoder-cmd (docs/encoders.md), or "
           "by an etlc that was built with ONNX Runtime (docs/recordings.md)";
}

cv::dnn::Net load(const std::string& bytes) {
    try {
        cv::dnn::Net net = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
        net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
        // What follows a product of two inputs, fused into it, is left out; so are other pairs
        // (https://github.com/opencv/opencv/issues/22649). It would save a hundredth of the time.
        net.enableFusion(false);
        return net;
    } catch (const cv::Exception& error) {
        refuse(kRefused, "is not run by OpenCV " CV_VERSION ": " + what_failed(error) + way_out());
    }
}

std::string text_of(const cv::dnn::MatShape& shape) {
    std::string text;
    for (const int n : shape) text += (text.empty() ? "" : " x ") + std::to_string(n);
    return text;
}

/// Whether a constant is taken along the axes that ONNX means: those from the last on. OpenCV
/// takes it along the first axes behind that of the images which have as many elements.
bool is_aligned(const std::vector<std::int64_t>& constant, const cv::dnn::MatShape& of) {
    if (constant.size() > of.size()) return false;
    std::int64_t elements = 1;
    for (const std::int64_t n : constant) elements *= n;
    const std::size_t before = of.size() - constant.size();
    std::int64_t covered = 1;
    for (std::size_t axis = 1; axis < of.size(); ++axis) {
        const std::int64_t own = axis < before ? 1 : constant[axis - before];
        const bool goes_on = covered < elements;
        if (own != (goes_on ? of[axis] : 1)) return false;
        covered *= goes_on ? of[axis] : 1;
    }
    return covered == elements;
}

/// What OpenCV computes otherwise than ONNX has it, and does not notice where axes are equally
/// long, is refused.
void check_constants(cv::dnn::Net& net, const Interface& model, const cv::dnn::MatShape& image) {
    for (const Node& node : model.nodes) {
        const int id = node.constant ? net.getLayerId(node.layer) : -1;
        if (id < 0 || net.getLayer(id)->type != "Scale") continue;
        std::vector<cv::dnn::MatShape> in, out;
        net.getLayerShapes(image, id, in, out);
        if (in.size() != 1 || is_aligned(*node.constant, in[0])) continue;
        refuse(kRefused, "is not run by OpenCV " CV_VERSION ": " + node.text +
                             " takes a constant of " + shape_text({"", true, *node.constant}) +
                             " along the wrong axes of its input, " + text_of(in[0]) +
                             "; export the constant with all axes" + way_out());
    }
}

/// The first node that cannot be run, found by running one after the other.
std::string node_that_fails(cv::dnn::Net& net, const Interface& model, const cv::Mat& blob) {
    for (const std::string& layer : net.getLayerNames()) {
        try {
            net.setInput(blob);
            net.forward(layer);
        } catch (const cv::Exception&) {
            const auto node =
                std::find_if(model.nodes.begin(), model.nodes.end(), [&](const Node& one) {
                    return layer == one.layer || layer.starts_with(one.layer + "/");
                });
            return (node == model.nodes.end() ? "'" + layer + "'" : node->text) + ": ";
        }
    }
    return "";
}

class OpenCvNetwork final : public Network {
public:
    explicit OpenCvNetwork(const Model& model)
        : model_(model), shape_{1, kChannels, model.height, model.width}, net_(load(model.bytes)) {}

    std::span<const float> run(std::vector<float>& image) override {
        const cv::Mat blob(shape_, CV_32F, image.data());
        try {
            if (embedding_.empty()) check_constants(net_, model_.interface, shape_);
            net_.setInput(blob);
            embedding_ = net_.forward();
        } catch (const cv::Exception& error) {
            refuse(kRefused, "cannot be run by OpenCV " CV_VERSION ": " +
                                 node_that_fails(net_, model_.interface, blob) +
                                 what_failed(error) + way_out());
        }
        if (embedding_.type() != CV_32F || !embedding_.isContinuous())
            refuse(kRefused, "gives no float by OpenCV " CV_VERSION + way_out());
        return {embedding_.ptr<float>(), embedding_.total()};
    }

private:
    const Model& model_;
    cv::dnn::MatShape shape_;
    cv::dnn::Net net_;
    cv::Mat embedding_;
};

}  // namespace

std::unique_ptr<Network> by_opencv(const Model& model) {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    return std::make_unique<OpenCvNetwork>(model);
}

}  // namespace etlc::embed::worker
