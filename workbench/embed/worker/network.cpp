#include "embed/worker/network.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <regex>

#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

/// Frees what ONNX Runtime allocated.
template <auto release>
struct Release {
    template <class T>
    void operator()(T* pointer) const {
        release(pointer);
    }
};

using Status = std::unique_ptr<ort::Status, Release<ort::release_status>>;
using Environment = std::unique_ptr<ort::Environment, Release<ort::release_environment>>;
using Options = std::unique_ptr<ort::Options, Release<ort::release_options>>;
using Session = std::unique_ptr<ort::Session, Release<ort::release_session>>;
using Memory = std::unique_ptr<ort::Memory, Release<ort::release_memory>>;
using Tensor = std::unique_ptr<ort::Tensor, Release<ort::release_tensor>>;
using Shape = std::unique_ptr<ort::Shape, Release<ort::release_shape>>;

namespace {

using recordings::frames::kRefused;

/// Puts a message of ONNX Runtime on one line, without its source locations: "NAME.h:91 void
/// Type::function(int, float) ".
std::string said(std::string why) {
    static const std::regex place(R"(\S+\.(h|cc):\d+ [^()]*\([^()]*\)( const)? )");
    constexpr std::size_t kLongest = 2000;
    if (why.size() > kLongest) why = why.substr(0, kLongest) + "...";
    std::replace_if(
        why.begin(), why.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    why = std::regex_replace(why, place, "");
    return why.substr(0, why.find_last_not_of(' ') + 1);
}

/// Drops the log of ONNX Runtime: errors are one line on standard error.
void say_nothing(void* /*unused*/, int /*unused*/, const char* /*unused*/, const char* /*unused*/,
                 const char* /*unused*/, const char* /*unused*/) {}

constexpr char kLoading[] = "is not run";
constexpr char kRunning[] = "cannot be run";

}  // namespace

struct Network::Parts {
    Parts(const Library& library, const Model& given)
        : version(library.version),
          model(given),
          shape{1, kChannels, given.height, given.width},
          environment(made<Environment>(kLoading,
                                        [](ort::Environment** result) {
                                            return ort::create_environment(
                                                say_nothing, nullptr, ort::kFatal, "etlc", result);
                                        })),
          memory(made<Memory>(kLoading, [](ort::Memory** result) {
              return ort::create_memory(ort::kArena, ort::kUsual, result);
          })) {
        const auto options = made<Options>(kLoading, ort::create_options);
        // One thread, so that the order of additions does not depend on the machine.
        done(kLoading, ort::set_threads(options.get(), 1));
        // Without these options, processors without a better instruction add products of 8 bits in
        // 16 bits with saturation, and float32 operations between quantised numbers run in 8 bits.
        done(kLoading, ort::set_optimization(options.get(), ort::kAllOptimizations));
        done(kLoading, ort::configure(options.get(), "session.x64quantprecision", "1"));
        done(kLoading, ort::configure(options.get(), "session.disable_quant_qdq", "1"));
        session = made<Session>(kLoading, [&](ort::Session** result) {
            return ort::create_session(environment.get(), given.bytes.data(), given.bytes.size(),
                                       options.get(), result);
        });
    }

    [[noreturn]] void refuse_for(const ort::Status& status, const std::string& doing) const {
        if (ort::error_code(&status) == ort::kInvalidProtobuf)
            refuse(kRefused, "is no ONNX model, or a damaged one");
        refuse(kRefused, doing + " by ONNX Runtime " + version + ": " +
                             said(ort::error_message(&status)) +
                             "; run the model by a command of your own instead: --encoder-cmd "
                             "(docs/recordings.md)");
    }

    /// Returns what a call creates; ends the process with `doing` in the message where it fails.
    template <class Holder, class Call>
    Holder made(const std::string& doing, const Call& call) const {
        typename Holder::pointer result = nullptr;
        done(doing, call(&result));
        return Holder(result);
    }

    void done(const std::string& doing, ort::Status* status) const {
        if (const Status failed(status); failed) refuse_for(*failed, doing);
    }

    /// Checks the shape that the model declares.
    Output output_of(ort::Tensor& value) const {
        const auto described = made<Shape>(
            kRunning, [&](ort::Shape** result) { return ort::shape_of(&value, result); });
        int type = 0;
        done(kRunning, ort::element_type(described.get(), &type));
        if (type != ort::kFloat)
            refuse(kRefused, "gives no float, expected an embedding of float32");
        std::size_t rank = 0;
        done(kRunning, ort::dimension_count(described.get(), &rank));
        std::vector<std::int64_t> found(rank);
        done(kRunning, ort::dimensions(described.get(), found.data(), rank));
        const Value& declared = model.interface.outputs[0];
        if (!fits(found, declared))
            refuse(kRefused, "gives '" + declared.name + "' of " + shape_text(found) +
                                 ", and declares " + shape_text(*declared.shape) +
                                 ": export it again");
        void* data = nullptr;
        done(kRunning, ort::tensor_data(&value, &data));
        const auto elements =
            std::accumulate(found.begin(), found.end(), std::int64_t{1}, std::multiplies<>());
        return {std::move(found),
                {static_cast<const float*>(data), static_cast<std::size_t>(elements)}};
    }

    std::string version;
    const Model& model;
    std::array<std::int64_t, 4> shape;
    Environment environment;
    Memory memory;
    Session session;
    Tensor embedding;
};

Network::Network(const Library& library, const Model& model)
    : parts_(std::make_unique<Parts>(library, model)) {}

Network::~Network() = default;

Network::Output Network::run(std::vector<float>& image) {
    Parts& p = *parts_;
    const auto input = p.made<Tensor>(kRunning, [&](ort::Tensor** result) {
        return ort::create_tensor(p.memory.get(), image.data(), image.size() * sizeof(float),
                                  p.shape.data(), p.shape.size(), ort::kFloat, result);
    });
    const ort::Tensor* const inputs[] = {input.get()};
    const char* const input_names[] = {p.model.interface.inputs[0].name.c_str()};
    const char* const output_names[] = {p.model.interface.outputs[0].name.c_str()};
    p.embedding = p.made<Tensor>(kRunning, [&](ort::Tensor** result) {
        return ort::run(p.session.get(), nullptr, input_names, inputs, 1, output_names, 1, result);
    });
    return p.output_of(*p.embedding);
}

}  // namespace etlc::embed::worker
