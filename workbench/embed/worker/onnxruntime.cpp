// Networks through ONNX Runtime, by its C interface, which stays as it is from release to release.
#include <onnxruntime_c_api.h>

#include <algorithm>
#include <array>
#include <regex>

#include "data/frames/protocol.hpp"
#include "embed/worker/network.hpp"
#include "embed/worker/prepare.hpp"
#include "embed/worker/worker.hpp"

namespace etlc::embed::worker {

namespace {

using data::frames::kRefused;

/// Of ONNX Runtime 1.12, the first that has LayerNormalization. What is called is in it, so any
/// later library does, whichever header is read here.
constexpr std::uint32_t kInterface = 12;

std::string library_name() {
    return std::string("ONNX Runtime ") + OrtGetApiBase()->GetVersionString();
}

const OrtApi& api() {
    static const OrtApi* const found = OrtGetApiBase()->GetApi(kInterface);
    if (found == nullptr)
        refuse(kRefused, "is not run by " + library_name() + ": expected 1.12 or later");
    return *found;
}

template <auto release>
struct Release {
    template <class T>
    void operator()(T* pointer) const {
        (api().*release)(pointer);
    }
};

using Status = std::unique_ptr<OrtStatus, Release<&OrtApi::ReleaseStatus>>;
using Environment = std::unique_ptr<OrtEnv, Release<&OrtApi::ReleaseEnv>>;
using Options = std::unique_ptr<OrtSessionOptions, Release<&OrtApi::ReleaseSessionOptions>>;
using Session = std::unique_ptr<OrtSession, Release<&OrtApi::ReleaseSession>>;
using Memory = std::unique_ptr<OrtMemoryInfo, Release<&OrtApi::ReleaseMemoryInfo>>;
using Tensor = std::unique_ptr<OrtValue, Release<&OrtApi::ReleaseValue>>;
using Shape =
    std::unique_ptr<OrtTensorTypeAndShapeInfo, Release<&OrtApi::ReleaseTensorTypeAndShapeInfo>>;

/// On one line, without the places in its sources: "NAME.h:91 void Type::function(int, float) ".
std::string said(std::string why) {
    static const std::regex place(R"(\S+\.(h|cc):\d+ [^()]*\([^()]*\)( const)? )");
    constexpr std::size_t kLongest = 2000;
    if (why.size() > kLongest) why = why.substr(0, kLongest) + "...";
    std::replace_if(
        why.begin(), why.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    why = std::regex_replace(why, place, "");
    return why.substr(0, why.find_last_not_of(' ') + 1);
}

/// Its message names the node.
[[noreturn]] void refuse_for(const OrtStatus& status, const std::string& doing) {
    if (api().GetErrorCode(&status) == ORT_INVALID_PROTOBUF)
        refuse(kRefused, "is no ONNX model, or a damaged one");
    refuse(kRefused, doing + " by " + library_name() + ": " + said(api().GetErrorMessage(&status)) +
                         "; run the model by a command of your own instead: --encoder-cmd "
                         "(docs/encoders.md)");
}

/// What a call makes; ends the process, `doing` being what was not done, where it fails.
template <class Holder, class Call>
Holder made(const std::string& doing, const Call& call) {
    typename Holder::pointer result = nullptr;
    if (const Status failed(call(&result)); failed) refuse_for(*failed, doing);
    return Holder(result);
}

void done(const std::string& doing, OrtStatus* status) {
    if (const Status failed(status); failed) refuse_for(*failed, doing);
}

/// Standard error has what goes wrong, on one line.
void ORT_API_CALL say_nothing(void* /*unused*/, OrtLoggingLevel /*unused*/, const char* /*unused*/,
                              const char* /*unused*/, const char* /*unused*/,
                              const char* /*unused*/) {}

constexpr char kLoading[] = "is not run";
constexpr char kRunning[] = "cannot be run";

class OnnxRuntimeNetwork final : public Network {
public:
    explicit OnnxRuntimeNetwork(const Model& model)
        : model_(model),
          shape_{1, kChannels, model.height, model.width},
          environment_(made<Environment>(kLoading,
                                         [](OrtEnv** result) {
                                             return api().CreateEnvWithCustomLogger(
                                                 say_nothing, nullptr, ORT_LOGGING_LEVEL_FATAL,
                                                 "etlc-embed", result);
                                         })),
          memory_(made<Memory>(kLoading, [](OrtMemoryInfo** result) {
              return api().CreateCpuMemoryInfo(OrtArenaAllocator, OrtMemTypeDefault, result);
          })) {
        const auto options = made<Options>(kLoading, [](OrtSessionOptions** result) {
            return api().CreateSessionOptions(result);
        });
        // Threads that wait for a frame leave the cores to what decodes it.
        done(kLoading,
             api().AddSessionConfigEntry(options.get(), "session.intra_op.allow_spinning", "0"));
        session_ = made<Session>(kLoading, [&](OrtSession** result) {
            return api().CreateSessionFromArray(environment_.get(), model.bytes.data(),
                                                model.bytes.size(), options.get(), result);
        });
    }

    std::span<const float> run(std::vector<float>& image) override {
        const auto input = made<Tensor>(kRunning, [&](OrtValue** result) {
            return api().CreateTensorWithDataAsOrtValue(
                memory_.get(), image.data(), image.size() * sizeof(float), shape_.data(),
                shape_.size(), ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT, result);
        });
        const OrtValue* const inputs[] = {input.get()};
        const char* const input_names[] = {model_.interface.inputs[0].name.c_str()};
        const char* const output_names[] = {model_.interface.outputs[0].name.c_str()};
        embedding_ = made<Tensor>(kRunning, [&](OrtValue** result) {
            return api().Run(session_.get(), nullptr, input_names, inputs, 1, output_names, 1,
                             result);
        });
        return floats_of(*embedding_);
    }

private:
    static std::span<const float> floats_of(OrtValue& value) {
        const auto shape = made<Shape>(kRunning, [&](OrtTensorTypeAndShapeInfo** result) {
            return api().GetTensorTypeAndShape(&value, result);
        });
        ONNXTensorElementDataType type{};
        std::size_t elements = 0;
        done(kRunning, api().GetTensorElementType(shape.get(), &type));
        done(kRunning, api().GetTensorShapeElementCount(shape.get(), &elements));
        if (type != ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT)
            refuse(kRefused, "gives no float, expected an embedding of float32");
        void* data = nullptr;
        done(kRunning, api().GetTensorMutableData(&value, &data));
        return {static_cast<const float*>(data), elements};
    }

    const Model& model_;
    std::array<std::int64_t, 4> shape_;
    Environment environment_;
    Memory memory_;
    Session session_;
    Tensor embedding_;
};

}  // namespace

std::unique_ptr<Network> by_onnxruntime(const Model& model) {
    return std::make_unique<OnnxRuntimeNetwork>(model);
}

}  // namespace etlc::embed::worker
