// Runs a network with ONNX Runtime.
// Takes: a model from one image to one output, and images. Gives: the output for each. Keeps true:
// the output has the shape that the model declares; a model that cannot be run ends the
// process with a line that names the node, where that is known.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "embed/worker/onnx.hpp"
#include "embed/worker/onnxruntime.hpp"
#include "embed/worker/prepare.hpp"

namespace etlc::embed::worker {

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

    struct Output {
        Extents shape;
        std::span<const float> values;  ///< valid until the next run
    };
    /// Returns what the model makes of an image of 3 x height x width.
    Output run(std::vector<float>& image);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace etlc::embed::worker
