#include "embed/worker/onnx.hpp"

#include <dlfcn.h>
#include <elf.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

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

/// Returns the text of a field.
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

namespace {

namespace fs = std::filesystem;
using recordings::frames::kNoRuntime;
using Paths = std::vector<fs::path>;

constexpr std::string_view kLibrary = "libonnxruntime.so";
constexpr char kExpected[] = ", expected ONNX Runtime 1.13 or later";
#if defined(__aarch64__)
constexpr std::string_view kNodeMachine = "arm64";
#else
constexpr std::string_view kNodeMachine = "x64";
#endif

[[noreturn]] void refuse_library(const std::string& what) {
    refuse(kNoRuntime, "is not run: " + what);
}

/// Lists the entries of a folder whose names have a prefix, the highest version first.
Paths named(const fs::path& folder, std::string_view beginning) {
    Paths found;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none))
        if (entry.path().filename().native().starts_with(beginning)) found.push_back(entry.path());
    std::sort(found.begin(), found.end(), [](const fs::path& a, const fs::path& b) {
        return ::strverscmp(a.c_str(), b.c_str()) > 0;
    });
    return found;
}

void add(Paths& to, const Paths& more) {
    to.insert(to.end(), more.begin(), more.end());
}

/// Returns the package folders of the python3 on the PATH.
Paths of_pip() {
    constexpr char kAsk[] =
        "python3 -c 'import importlib.util as u, sys; sys.path = [p for p in sys.path if p]; "
        "s = u.find_spec(\"onnxruntime\"); print(*(s.submodule_search_locations if s else ()))' "
        "2> /dev/null";
    std::string folder;
    FILE* const asked = ::popen(kAsk, "r");
    if (asked == nullptr) return {};
    std::array<char, 4096> part{};
    while (std::fgets(part.data(), part.size(), asked) != nullptr) folder += part.data();
    ::pclose(asked);
    while (!folder.empty() && folder.back() == '\n') folder.pop_back();
    return folder.empty() ? Paths{} : named(fs::path(folder) / "capi", kLibrary);
}

/// Returns the package folders of node and npm: in the working directory and above, and beside the
/// node on the PATH.
Paths folders_of_npm() {
    Paths folders;
    std::error_code none;
    for (fs::path at = fs::current_path(none); !at.empty(); at = at.parent_path()) {
        folders.push_back(at / "node_modules");
        if (at == at.root_path()) break;
    }
    const char* const path = std::getenv("PATH");
    std::istringstream programs(path == nullptr ? "" : path);
    for (std::string folder; std::getline(programs, folder, ':');)
        if (fs::exists(fs::path(folder) / "node", none))
            folders.push_back(fs::path(folder).parent_path() / "lib" / "node_modules");
    folders.emplace_back("/usr/local/lib/node_modules");
    return folders;
}

Paths of_npm() {
    Paths found;
    for (const fs::path& folder : folders_of_npm())
        for (const fs::path& version : named(folder / "onnxruntime-node" / "bin", "napi-v"))
            add(found, named(version / "linux" / kNodeMachine, kLibrary));
    return found;
}

/// Finds libraries of system packages, whose names may end in any version.
Paths of_system() {
    Paths found;
    for (const char* const folder :
         {"/usr/local/lib", "/usr/lib/" ETLC_LIBRARY_ARCHITECTURE, "/usr/lib64", "/usr/lib"})
        add(found, named(folder, kLibrary));
    return found;
}

/// Finds the library that a path names: a file, or one in a folder of a release or package.
fs::path library_at(const std::string& where) {
    std::error_code none;
    if (!fs::exists(where, none)) refuse_library("there is no '" + where + "'");
    if (!fs::is_directory(where, none)) return where;
    for (const char* const inner : {"", "lib", "capi"})
        if (const Paths found = named(fs::path(where) / inner, kLibrary); !found.empty())
            return found.front();
    refuse_library("'" + where + "' holds no " + std::string(kLibrary) + kExpected);
}

using Head = ElfW(Ehdr);

/// Returns the machine of an ELF file; nothing for other files.
std::optional<Head> head_of(const fs::path& path) {
    Head head{};
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(&head), sizeof head);
    if (!file || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0) return std::nullopt;
    return head;
}

/// Returns whether programs for both machines run on one.
bool are_alike(const Head& one, const Head& other) {
    return one.e_ident[EI_CLASS] == other.e_ident[EI_CLASS] &&
           one.e_ident[EI_DATA] == other.e_ident[EI_DATA] && one.e_machine == other.e_machine;
}

struct Opened {
    void* library = nullptr;
    std::string name;
};

Opened open(const fs::path& found) {
    const fs::path path = fs::absolute(found);  // dlopen() searches elsewhere for a bare name
    const std::string name = "'" + path.string() + "'";
    const auto head = head_of(path);
    if (!head) refuse_library(name + " is no shared library" + kExpected);
    if (!are_alike(*head, head_of("/proc/self/exe").value_or(*head)))
        refuse_library(name + " is for another processor than this etlc");
    // The table of sections is at its end; without it a signal would stop the loader.
    if (head->e_shoff + std::size_t{head->e_shnum} * head->e_shentsize > fs::file_size(path))
        refuse_library(name + " is cut: its end is missing");
    void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) refuse_library(name + " cannot be loaded: " + ::dlerror());
    return {library, name};
}

/// Finds the library without a path: installed by pip, npm or the system.
Opened find() {
    for (const auto& where : {of_pip, of_npm})
        if (const Paths found = where(); !found.empty()) return open(found.front());
    for (const char* const name : {"libonnxruntime.so.1", "libonnxruntime.so"})
        if (void* const library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL)) return {library, name};
    if (const Paths found = of_system(); !found.empty()) return open(found.front());
    refuse_library(
        "there is no ONNX Runtime, which runs networks: pip install onnxruntime, or npm install "
        "onnxruntime-node, or unpack a release of it and name its folder, --onnxruntime FOLDER "
        "(Debian 13: apt install libonnxruntime-dev; docs/recordings.md)");
}

struct Base {
    const ort::Function* (*table)(std::uint32_t interface);
    const char* (*version)();
};

const ort::Function* loaded = nullptr;

}  // namespace

const ort::Function* ort::table() {
    return loaded;
}

Library load_onnxruntime(const std::string& where) {
    const char* const environment = std::getenv("ETLC_ONNXRUNTIME");
    const std::string named = where.empty() && environment != nullptr ? environment : where;
    const Opened opened = named.empty() ? find() : open(library_at(named));
    auto* const base =
        reinterpret_cast<const Base* (*)()>(::dlsym(opened.library, "OrtGetApiBase"));
    if (base == nullptr) refuse_library(opened.name + " is another library" + kExpected);
    Dl_info place{};
    ::dladdr(reinterpret_cast<void*>(base), &place);
    loaded = base()->table(ort::kInterface);
    const std::string version = base()->version();
    if (loaded == nullptr) refuse_library(opened.name + " is ONNX Runtime " + version + kExpected);
    return {place.dli_fname, version};
}

}  // namespace etlc::embed::worker
