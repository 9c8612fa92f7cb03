// Runs a network with ONNX Runtime.
// Takes: a model from one image to one embedding, and frames. Gives: the embedding of each. Keeps
// true: the embedding has the shape that the model declares; a model that cannot be run ends the
// process with a line that names the node, where that is known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "embed/worker/onnx.hpp"
#include "embed/worker/onnxruntime.hpp"

namespace etlc::embed::worker {

inline constexpr int kChannels = 3;

struct Settings {
    int height = 0;
    int width = 0;
    float mean[kChannels] = {};
    float deviation[kChannels] = {};

    std::size_t elements() const {
        return std::size_t(kChannels) * std::size_t(height) * std::size_t(width);
    }
};

struct Frame {
    int height = 0;
    int width = 0;
    std::vector<std::uint8_t> rgb;
};

/// Prepares a frame for a network: resizes it in float32 by bilinear interpolation, without
/// smoothing, then computes (x / 255 - mean) / deviation, channels x rows x columns, red, green,
/// blue. `image` has room for the result.
void prepare(const Frame& frame, const Settings& settings, std::vector<float>& image);

struct Model {
    std::string bytes;
    Interface interface;
    int height = 0;  ///< height of its images
    int width = 0;
};

class Network {
public:
    /// The model must outlive the network.
    Network(const Library& library, const Model& model);
    ~Network();

    /// Returns the embedding of an image of 3 x height x width, valid until the next run.
    std::span<const float> run(std::vector<float>& image);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace etlc::embed::worker
