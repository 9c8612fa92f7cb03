// A network that runs, by one of the libraries that can.
// Takes: a model of one image to one embedding, and images as `prepare` leaves them. Gives: the
// embedding of each. Keeps true: what of a model is not run, or not as ONNX has it, ends the
// process with a line that names the library, and the node where that is known.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "embed/worker/onnx.hpp"

namespace etlc::embed::worker {

/// Whether this etlc-embed was built with ONNX Runtime.
inline constexpr bool kHasOnnxRuntime = ETLC_ONNXRUNTIME != 0;

struct Model {
    std::string bytes;
    Interface interface;
    int height = 0;  ///< of its images
    int width = 0;
};

class Network {
public:
    virtual ~Network() = default;
    /// The embedding of an image of 3 x height x width, which is there until the next run.
    virtual std::span<const float> run(std::vector<float>& image) = 0;
};

/// The model outlives it.
std::unique_ptr<Network> by_opencv(const Model& model);
/// Only where `kHasOnnxRuntime`.
std::unique_ptr<Network> by_onnxruntime(const Model& model);

}  // namespace etlc::embed::worker
