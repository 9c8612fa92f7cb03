// The interface of an ONNX model, read from its protocol buffer: the names and shapes of its inputs
// and outputs. Keeps true: no field is read beyond the bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::embed::worker {

using Extents = std::vector<std::int64_t>;  ///< 0: any number

struct Value {
    std::string name;
    bool is_float = false;
    std::optional<Extents> shape;  ///< nothing: any shape
};

struct Interface {
    std::vector<Value> inputs;  ///< without the weights, which older files list as inputs
    std::vector<Value> outputs;
    std::string file_beside;  ///< an external file of weights; empty: none
};

/// Reads the interface of a model; nothing where the bytes are no ONNX model.
std::optional<Interface> interface_of(std::string_view model);

/// Returns whether a shape is as declared.
bool fits(const Extents& shape, const Value& declared);

/// Returns "1 x 3 x ? x ?".
std::string shape_text(const Extents& shape);

}  // namespace etlc::embed::worker
