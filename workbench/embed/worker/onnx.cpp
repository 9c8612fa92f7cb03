#include "embed/worker/onnx.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace etlc::embed::worker {

namespace {

// Field numbers of onnx.proto, https://github.com/onnx/onnx/blob/v1.12.0/onnx/onnx.proto
constexpr std::uint64_t kGraph = 7;                                    // ModelProto
constexpr std::uint64_t kInitializer = 5, kInput = 11, kOutput = 12;   // GraphProto
constexpr std::uint64_t kNode = 1;                                     // GraphProto
constexpr std::uint64_t kNodeInput = 1, kNodeOutput = 2;               // NodeProto
constexpr std::uint64_t kNodeName = 3, kOperator = 4, kAttribute = 5;  // NodeProto
constexpr std::uint64_t kAttributeTensor = 5, kAttributeGraph = 6;     // AttributeProto
constexpr std::uint64_t kTensorShape = 1, kTensorName = 8;             // TensorProto
constexpr std::uint64_t kTensorFile = 13;                              // TensorProto
constexpr std::uint64_t kKey = 1, kKeyValue = 2;                       // StringStringEntryProto
constexpr std::uint64_t kName = 1, kType = 2;                          // ValueInfoProto
constexpr std::uint64_t kTensorType = 1;                               // TypeProto
constexpr std::uint64_t kElement = 1, kShape = 2;                      // TypeProto.Tensor
constexpr std::uint64_t kDimension = 1;                                // TensorShapeProto
constexpr std::uint64_t kDimensionValue = 1;                           // its Dimension
constexpr std::uint64_t kFloat = 1;                                    // TensorProto.DataType

/// One message: its fields in order.
class Message {
public:
    explicit Message(std::string_view all) : rest_(all) {}

    /// The next field; false at the end, or where the bytes are no message.
    bool next() {
        if (rest_.empty() || !sound_) return false;
        const std::uint64_t key = varint();
        field = key >> 3U;
        is_number = (key & 7U) == 0;
        switch (key & 7U) {
            case 0: number = varint(); break;
            case 1: skip(8); break;
            case 2: bytes = take(varint()); break;
            case 5: skip(4); break;
            default: sound_ = false;
        }
        return sound_;
    }

    /// The next of numbers that stand one after the other.
    bool next_packed() {
        if (rest_.empty() || !sound_) return false;
        number = varint();
        return sound_;
    }

    bool sound() const { return sound_; }

    bool is_number = false;  ///< else it has bytes
    std::uint64_t field = 0;
    std::uint64_t number = 0;
    std::string_view bytes;

private:
    std::uint64_t varint() {
        std::uint64_t result = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            const std::string_view one = take(1);
            if (one.empty()) return 0;
            const auto byte = static_cast<unsigned char>(one[0]);
            result |= std::uint64_t{byte & 0x7fU} << shift;
            if (byte < 0x80) return result;
        }
        sound_ = false;
        return 0;
    }

    std::string_view take(std::uint64_t n) {
        sound_ = sound_ && n <= rest_.size();
        if (!sound_) return {};
        const std::string_view taken = rest_.substr(0, n);
        rest_.remove_prefix(n);
        return taken;
    }

    void skip(std::uint64_t n) { static_cast<void>(take(n)); }

    std::string_view rest_;
    bool sound_ = true;
};

std::vector<std::int64_t> shape_of(std::string_view bytes) {
    std::vector<std::int64_t> shape;
    for (Message message(bytes); message.next();) {
        if (message.field != kDimension) continue;
        shape.push_back(0);
        for (Message dimension(message.bytes); dimension.next();)
            if (dimension.field == kDimensionValue)
                shape.back() =
                    std::max<std::int64_t>(static_cast<std::int64_t>(dimension.number), 0);
    }
    return shape;
}

void read_type(std::string_view bytes, Value& value) {
    for (Message type(bytes); type.next();) {
        if (type.field != kTensorType) continue;
        for (Message tensor(type.bytes); tensor.next();) {
            if (tensor.field == kElement) value.is_float = tensor.number == kFloat;
            if (tensor.field == kShape) value.shape = shape_of(tensor.bytes);
        }
    }
}

Value value_of(std::string_view bytes) {
    Value value;
    for (Message message(bytes); message.next();) {
        if (message.field == kName) value.name = message.bytes;
        if (message.field == kType) read_type(message.bytes, value);
    }
    return value;
}

/// Repeated numbers, which a file may hold one by one or packed.
void add_numbers(const Message& field, std::vector<std::int64_t>& to) {
    if (field.is_number) return to.push_back(static_cast<std::int64_t>(field.number));
    for (Message packed(field.bytes); packed.next_packed();)
        to.push_back(static_cast<std::int64_t>(packed.number));
}

struct Tensor {
    std::string name;
    std::vector<std::int64_t> shape;
    std::string file;  ///< that holds its numbers; empty: it holds them itself
};

/// What one of the words on a tensor's file says.
std::string file_in(std::string_view bytes) {
    std::string_view key, value;
    for (Message entry(bytes); entry.next();) {
        if (entry.field == kKey) key = entry.bytes;
        if (entry.field == kKeyValue) value = entry.bytes;
    }
    return std::string(key == "location" ? value : "");
}

Tensor tensor_of(std::string_view bytes) {
    Tensor tensor;
    for (Message message(bytes); message.next();) {
        if (message.field == kTensorFile && tensor.file.empty())
            tensor.file = file_in(message.bytes);
        if (message.field == kTensorName) tensor.name = message.bytes;
        if (message.field == kTensorShape) add_numbers(message, tensor.shape);
    }
    return tensor;
}

using Shapes = std::map<std::string, std::vector<std::int64_t>, std::less<>>;

struct StoredNode {
    std::string kind;
    std::string name;
    std::vector<std::string> inputs;
    std::vector<std::string> outputs;
};

/// `tensors`: gets what a node Constant gives.
StoredNode node_of(std::string_view bytes, Shapes& tensors) {
    StoredNode node;
    std::vector<std::int64_t> shape;
    for (Message message(bytes); message.next();) {
        if (message.field == kNodeInput) node.inputs.emplace_back(message.bytes);
        if (message.field == kNodeOutput) node.outputs.emplace_back(message.bytes);
        if (message.field == kNodeName) node.name = message.bytes;
        if (message.field == kOperator) node.kind = message.bytes;
        if (message.field != kAttribute) continue;
        for (Message attribute(message.bytes); attribute.next();)
            if (attribute.field == kAttributeTensor && !attribute.is_number)
                shape = tensor_of(attribute.bytes).shape;
    }
    if (node.kind == "Constant" && !node.outputs.empty()) tensors[node.outputs[0]] = shape;
    return node;
}

Node described(const StoredNode& node, const Shapes& tensors) {
    constexpr std::array<std::string_view, 4> kArithmetic = {"Add", "Sub", "Mul", "Div"};
    const std::string output = node.outputs.empty() ? "" : node.outputs[0];
    Node result;
    result.layer = node.name.empty() ? "onnx_node_output_0!" + output : "onnx_node!" + node.name;
    result.text = node.kind + " '" + (node.name.empty() ? output : node.name) + "'";
    if (std::find(kArithmetic.begin(), kArithmetic.end(), node.kind) == kArithmetic.end())
        return result;
    for (const std::string& input : node.inputs)
        if (const auto tensor = tensors.find(input); tensor != tensors.end())
            result.constant = tensor->second;
    return result;
}

/// A file that tensors of a graph lie in, or those of its branches and loops. `levels`: of these,
/// one in the other; protocol buffers with more are none.
std::string file_beside(std::string_view graph, unsigned levels = 30) {
    std::string found;
    const auto look = [&](std::uint64_t field, std::uint64_t tensor, std::string_view bytes) {
        if (found.empty() && field == tensor) found = tensor_of(bytes).file;
    };
    for (Message part(graph); part.next() && found.empty();) {
        look(part.field, kInitializer, part.bytes);
        if (part.field != kNode) continue;
        for (Message node(part.bytes); node.next();) {
            if (node.field != kAttribute) continue;
            for (Message attribute(node.bytes); attribute.next();) {
                look(attribute.field, kAttributeTensor, attribute.bytes);
                if (attribute.field == kAttributeGraph && levels > 0 && found.empty())
                    found = file_beside(attribute.bytes, levels - 1);
            }
        }
    }
    return found;
}

}  // namespace

std::optional<Interface> interface_of(std::string_view model) {
    Interface result;
    Shapes weights;
    std::vector<StoredNode> nodes;
    Message message(model);
    while (message.next()) {
        if (message.field != kGraph) continue;
        if (result.file_beside.empty()) result.file_beside = file_beside(message.bytes);
        Message graph(message.bytes);
        while (graph.next()) {
            if (graph.field == kInitializer) {
                Tensor weight = tensor_of(graph.bytes);
                weights[weight.name] = std::move(weight.shape);
            }
            if (graph.field == kNode) nodes.push_back(node_of(graph.bytes, weights));
            if (graph.field == kInput) result.inputs.push_back(value_of(graph.bytes));
            if (graph.field == kOutput) result.outputs.push_back(value_of(graph.bytes));
        }
        if (!graph.sound()) return std::nullopt;
    }
    if (!message.sound() || result.inputs.empty() || result.outputs.empty()) return std::nullopt;
    std::erase_if(result.inputs, [&](const Value& input) { return weights.contains(input.name); });
    for (const StoredNode& node : nodes) result.nodes.push_back(described(node, weights));
    return result;
}

std::string shape_text(const Value& value) {
    std::string text;
    for (const std::int64_t n : value.shape)
        text += (text.empty() ? "" : " x ") + (n == 0 ? std::string("?") : std::to_string(n));
    return text;
}

}  // namespace etlc::embed::worker
