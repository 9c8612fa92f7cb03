#include "embed/worker/onnx.hpp"

#include <algorithm>
#include <set>

namespace etlc::embed::worker {

namespace {

// Field numbers of onnx.proto, https://github.com/onnx/onnx/blob/v1.12.0/onnx/onnx.proto
constexpr std::uint64_t kGraph = 7;                                   // ModelProto
constexpr std::uint64_t kInitializer = 5, kInput = 11, kOutput = 12;  // GraphProto
constexpr std::uint64_t kTensorName = 8, kTensorFile = 13;            // TensorProto
constexpr std::uint64_t kKey = 1, kKeyValue = 2;                      // StringStringEntryProto
constexpr std::uint64_t kName = 1, kType = 2;                         // ValueInfoProto
constexpr std::uint64_t kTensorType = 1;                              // TypeProto
constexpr std::uint64_t kElement = 1, kShape = 2;                     // TypeProto.Tensor
constexpr std::uint64_t kDimension = 1;                               // TensorShapeProto
constexpr std::uint64_t kDimensionValue = 1;                          // its Dimension
constexpr std::uint64_t kFloat = 1;                                   // TensorProto.DataType

/// The nesting of messages that contain tensors.
enum class Part { model, function, graph, node, attribute, sparse, tensor };
struct Inner {
    Part of;
    std::uint64_t field;
    Part is;
};
constexpr Inner kInner[] = {{Part::model, kGraph, Part::graph},
                            {Part::model, 25, Part::function},
                            {Part::function, 7, Part::node},
                            {Part::graph, 1, Part::node},
                            {Part::graph, kInitializer, Part::tensor},
                            {Part::graph, 15, Part::sparse},
                            {Part::node, 5, Part::attribute},
                            {Part::attribute, 5, Part::tensor},
                            {Part::attribute, 6, Part::graph},
                            {Part::attribute, 10, Part::tensor},
                            {Part::attribute, 11, Part::graph},
                            {Part::attribute, 22, Part::sparse},
                            {Part::attribute, 23, Part::sparse},
                            {Part::sparse, 1, Part::tensor},
                            {Part::sparse, 2, Part::tensor}};

/// The fields of a message, in order.
class Message {
public:
    explicit Message(std::string_view all) : rest_(all) {}

    /// Reads the next field; false at the end, or where the bytes are no message.
    bool next() {
        if (rest_.empty() || !sound_) return false;
        const std::uint64_t key = varint();
        field = key >> 3U;
        bytes = {};
        switch (key & 7U) {
            case 0: number = varint(); break;
            case 1: skip(8); break;
            case 2: bytes = take(varint()); break;
            case 5: skip(4); break;
            default: sound_ = false;
        }
        return sound_;
    }

    bool sound() const { return sound_; }

    std::uint64_t field = 0;
    std::uint64_t number = 0;  ///< value of a field without bytes
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

Extents shape_of(std::string_view bytes) {
    Extents shape;
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

std::string_view text_in(std::string_view bytes, std::uint64_t field) {
    std::string_view text;
    for (Message message(bytes); message.next();)
        if (message.field == field) text = message.bytes;
    return text;
}

/// Returns the external file of a tensor's numbers; empty where the tensor contains them.
std::string file_of(std::string_view tensor) {
    for (Message message(tensor); message.next();)
        if (message.field == kTensorFile && text_in(message.bytes, kKey) == "location")
            return std::string(text_in(message.bytes, kKeyValue));
    return "";
}

/// Finds an external file of any tensor; empty where there is none. `levels`: the deepest nesting
/// of messages that protocol buffers allow.
std::string file_beside(Part part, std::string_view bytes, unsigned levels = 100) {
    if (part == Part::tensor) return file_of(bytes);
    for (Message message(bytes); levels > 0 && message.next();)
        for (const Inner& inner : kInner)
            if (inner.of == part && inner.field == message.field)
                if (std::string file = file_beside(inner.is, message.bytes, levels - 1);
                    !file.empty())
                    return file;
    return "";
}

}  // namespace

std::optional<Interface> interface_of(std::string_view model) {
    Interface result;
    result.file_beside = file_beside(Part::model, model);
    std::set<std::string_view> weights;
    Message message(model);
    while (message.next()) {
        if (message.field != kGraph) continue;
        Message graph(message.bytes);
        while (graph.next()) {
            if (graph.field == kInitializer) weights.insert(text_in(graph.bytes, kTensorName));
            if (graph.field == kInput) result.inputs.push_back(value_of(graph.bytes));
            if (graph.field == kOutput) result.outputs.push_back(value_of(graph.bytes));
        }
        if (!graph.sound()) return std::nullopt;
    }
    if (!message.sound() || result.inputs.empty() || result.outputs.empty()) return std::nullopt;
    std::erase_if(result.inputs, [&](const Value& input) { return weights.contains(input.name); });
    return result;
}

bool fits(const Extents& shape, const Value& declared) {
    return !declared.shape ||
           std::equal(shape.begin(), shape.end(), declared.shape->begin(), declared.shape->end(),
                      [](std::int64_t is, std::int64_t said) { return said == 0 || is == said; });
}

std::string shape_text(const Extents& shape) {
    std::string text;
    for (const std::int64_t n : shape)
        text += (text.empty() ? "" : " x ") + (n == 0 ? std::string("?") : std::to_string(n));
    return text.empty() ? "no dimensions" : text;
}

}  // namespace etlc::embed::worker
