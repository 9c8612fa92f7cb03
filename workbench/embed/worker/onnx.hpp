// What an ONNX model takes and gives, read from its protocol buffer.
// Takes: the bytes of the file. Gives: the names and shapes of its inputs and outputs as the file
// declares them. Keeps true: no field is read beyond the bytes; a file that is none gives nothing.
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
    std::optional<Extents> shape;  ///< nothing: any
};

struct Interface {
    std::vector<Value> inputs;  ///< without the weights, which older files list here too
    std::vector<Value> outputs;
    std::string file_beside;  ///< one that holds weights; empty: there is none
};

std::optional<Interface> interface_of(std::string_view model);

/// Whether what is there is as declared.
bool fits(const Extents& shape, const Value& declared);

/// "1 x 3 x ? x ?"
std::string shape_text(const Extents& shape);

}  // namespace etlc::embed::worker
