// What an ONNX model takes and gives, read from its protocol buffer.
// Takes: the bytes of the file. Gives: the names and shapes of its inputs and outputs, and its
// nodes. Keeps true: no field is read beyond the bytes; a file that is none gives nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::embed::worker {

struct Value {
    std::string name;
    bool is_float = false;
    std::vector<std::int64_t> shape;  ///< 0: any number
};

struct Node {
    std::string layer;  ///< what OpenCV calls it
    std::string text;   ///< "Mul 'blocks.0/norm'"
    /// Of arithmetic, Add, Sub, Mul or Div: the shape of an operand that is constant.
    std::optional<std::vector<std::int64_t>> constant;
};

struct Interface {
    std::vector<Value> inputs;  ///< without the weights, which older files list here too
    std::vector<Value> outputs;
    std::vector<Node> nodes;
    std::string file_beside;  ///< one that holds weights; empty: there is none
};

std::optional<Interface> interface_of(std::string_view model);

/// "1 x 3 x ? x ?"
std::string shape_text(const Value& value);

}  // namespace etlc::embed::worker
