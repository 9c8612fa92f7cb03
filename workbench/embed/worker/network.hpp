// A network that runs, by ONNX Runtime.
// Takes: a model of one image to one embedding, and images as `prepare` leaves them. Gives: the
// embedding of each. Keeps true: the embedding has the shape that the model declares; what of a
// model is not run ends the process with a line that names the node, where that is known.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "embed/worker/onnx.hpp"
#include "embed/worker/onnxruntime.hpp"

namespace etlc::embed::worker {

struct Model {
    std::string bytes;
    Interface interface;
    int height = 0;  ///< of its images
    int width = 0;
};

class Network {
public:
    /// The model outlives it.
    Network(const Library& library, const Model& model);
    ~Network();

    /// The embedding of an image of 3 x height x width, which is there until the next run.
    std::span<const float> run(std::vector<float>& image);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace etlc::embed::worker
