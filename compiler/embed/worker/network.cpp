// A network through OpenCV's dnn, a frame at a time.
#include <algorithm>
#include <bit>
#include <fstream>
#include <iterator>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <vector>

#include "data/frames/protocol.hpp"
#include "embed/worker/onnx.hpp"
#include "embed/worker/worker.hpp"

namespace etlc::embed::worker {

namespace {

using data::frames::kMaxExtent;
using data::frames::kMaxPixels;
using data::frames::kRefused;
using data::frames::kWrongCall;

constexpr int kChannels = 3;

struct Settings {
    int height = 0;
    int width = 0;
    float mean[kChannels] = {};
    float deviation[kChannels] = {};
};

std::string listed(const std::vector<Value>& values) {
    std::string text;
    for (const Value& value : values)
        text += (text.empty() ? "'" : ", '") + value.name + "' (" + shape_text(value) + ")";
    return text;
}

/// Of one image to one embedding; else a refusal.
void check_interface(const Interface& model) {
    if (model.inputs.size() != 1)
        refuse(kRefused, "takes " + std::to_string(model.inputs.size()) +
                             " inputs, expected one image: " + listed(model.inputs));
    if (model.outputs.size() != 1)
        refuse(kRefused, "gives " + std::to_string(model.outputs.size()) +
                             " outputs, expected one embedding: " + listed(model.outputs) +
                             "; export it with one of them");
    const Value& input = model.inputs[0];
    const std::vector<std::int64_t>& shape = input.shape;
    const bool is_image = input.is_float && shape.size() == 4 && shape[0] <= 1 &&
                          (shape[1] == kChannels || shape[1] == 0);
    if (!is_image)
        refuse(kRefused, "takes '" + input.name + "' of " + (input.is_float ? "" : "not float, ") +
                             shape_text(input) +
                             ", expected float 1 x 3 x rows x columns, an image at a time");
}

Settings settings_of(const Words& options, const Value& input) {
    Settings settings;
    const std::vector<double> image = options.numbers("--image");
    const std::vector<double> mean = options.numbers("--mean", {0, 0, 0});
    const std::vector<double> deviation = options.numbers("--deviation", {1, 1, 1});
    if (mean.size() != kChannels || deviation.size() != kChannels ||
        (!image.empty() && image.size() != 2))
        refuse(kWrongCall, "--image takes two numbers, --mean and --deviation three");
    const std::int64_t own[] = {input.shape[2], input.shape[3]};
    if (image.empty() && (own[0] == 0 || own[1] == 0))
        refuse(kRefused, "takes images of any size (" + shape_text(input) +
                             "): say which in the spec, as image [224, 224]");
    settings.height = image.empty() ? static_cast<int>(own[0]) : static_cast<int>(image[0]);
    settings.width = image.empty() ? static_cast<int>(own[1]) : static_cast<int>(image[1]);
    if ((own[0] != 0 && own[0] != settings.height) || (own[1] != 0 && own[1] != settings.width))
        refuse(kRefused, "takes images of " + std::to_string(own[0]) + " x " +
                             std::to_string(own[1]) + ", the spec says image [" +
                             std::to_string(settings.height) + ", " +
                             std::to_string(settings.width) + "]");
    for (int c = 0; c < kChannels; ++c) {
        settings.mean[c] = static_cast<float>(mean[static_cast<std::size_t>(c)]);
        settings.deviation[c] = static_cast<float>(deviation[static_cast<std::size_t>(c)]);
    }
    return settings;
}

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

constexpr char kWayOut[] =
    "; run the model by a command of your own instead: --encoder-cmd (docs/encoders.md)";

cv::dnn::Net load(const std::string& bytes) {
    try {
        cv::dnn::Net net = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
        net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
        // What follows a product of two inputs, fused into it, is left out; so are other pairs
        // (https://github.com/opencv/opencv/issues/22649). It would save a hundredth of the time.
        net.enableFusion(false);
        return net;
    } catch (const cv::Exception& error) {
        refuse(kRefused, "is not run by OpenCV " CV_VERSION ": " + what_failed(error) + kWayOut);
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
                             "; export the constant with all axes" + kWayOut);
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

/// Where a pixel lies between two of the image, along an axis: pixel centres are at half numbers.
struct Between {
    int low = 0;
    int high = 0;
    float part = 0;  ///< of the way
};

std::vector<Between> between(int of_image, int wanted) {
    std::vector<Between> result;
    for (int i = 0; i < wanted; ++i) {
        const double at = std::max((i + 0.5) * of_image / wanted - 0.5, 0.0);
        const int low = std::min(static_cast<int>(at), of_image - 1);
        result.push_back({low, std::min(low + 1, of_image - 1), static_cast<float>(at - low)});
    }
    return result;
}

/// Resized in float32 by bilinear interpolation, without smoothing; then (x / 255 - mean) /
/// deviation, the channels red, green, blue one after the other. Only the pixels that count are
/// looked at.
void fill_blob(const cv::Mat& rgb, const Settings& settings, cv::Mat& blob) {
    const std::vector<Between> rows = between(rgb.rows, settings.height);
    const std::vector<Between> columns = between(rgb.cols, settings.width);
    const std::size_t pixels = rows.size() * columns.size();
    auto* to = blob.ptr<float>();
    for (const Between& row : rows) {
        const auto* const upper = rgb.ptr<std::uint8_t>(row.low);
        const auto* const lower = rgb.ptr<std::uint8_t>(row.high);
        for (const Between& column : columns) {
            for (int c = 0; c < kChannels; ++c) {
                const auto mixed = [&](const std::uint8_t* line) {
                    const float left = line[kChannels * column.low + c];
                    return left + column.part * (line[kChannels * column.high + c] - left);
                };
                const float above = mixed(upper);
                const float value = above + row.part * (mixed(lower) - above);
                to[static_cast<std::size_t>(c) * pixels] =
                    (value / 255.0F - settings.mean[c]) / settings.deviation[c];
            }
            ++to;
        }
    }
}

void write_floats(const cv::Mat& values) {
    static_assert(std::endian::native == std::endian::little);
    write_out(values.ptr<float>(), values.total() * sizeof(float));
}

bool read_head(std::uint32_t& height, std::uint32_t& width) {
    std::uint8_t head[8];
    if (!read_in(head, sizeof head)) return false;
    std::uint32_t* const numbers[] = {&height, &width};
    for (unsigned n = 0; n < 2; ++n) {
        *numbers[n] = 0;
        for (unsigned i = 0; i < 4; ++i) *numbers[n] |= std::uint32_t{head[4 * n + i]} << (8 * i);
        if (*numbers[n] == 0 || *numbers[n] > kMaxExtent)
            refuse(kWrongCall, "standard input holds no frames");
    }
    if (std::uint64_t{height} * width > kMaxPixels)
        refuse(kWrongCall, "standard input holds no frames");
    return true;
}

}  // namespace

void encode(const std::string& model, const Words& options) {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    std::ifstream file(model, std::ios::binary);
    if (!file) refuse(kRefused, "cannot be read");
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    const auto interface = interface_of(bytes);
    if (!interface) refuse(kRefused, "is no ONNX model, or a damaged one");
    check_interface(*interface);
    const Settings settings = settings_of(options, interface->inputs[0]);
    cv::dnn::Net net = load(bytes);
    const cv::dnn::MatShape shape = {1, kChannels, settings.height, settings.width};
    cv::Mat blob(shape, CV_32F);
    cv::Mat rgb;
    std::size_t dimension = 0;
    for (std::uint32_t height = 0, width = 0; read_head(height, width);) {
        rgb.create(static_cast<int>(height), static_cast<int>(width), CV_8UC3);
        if (!read_in(rgb.data, 3 * rgb.total())) refuse(kWrongCall, "a frame ends too soon");
        fill_blob(rgb, settings, blob);
        cv::Mat embedding;
        try {
            if (dimension == 0) check_constants(net, *interface, shape);
            net.setInput(blob);
            embedding = net.forward();
        } catch (const cv::Exception& error) {
            refuse(kRefused, "cannot be run by OpenCV " CV_VERSION ": " +
                                 node_that_fails(net, *interface, blob) + what_failed(error) +
                                 kWayOut);
        }
        if (dimension == 0) write_number(static_cast<std::uint32_t>(embedding.total()));
        dimension = embedding.total();
        write_floats(embedding);
    }
}

}  // namespace etlc::embed::worker
