// ONNX Runtime, loaded from this machine: its version, and the functions that etlc-embed calls.
// Keeps true: etlc builds without it; a file that is not ONNX Runtime ends the process with a line
// that says what was found and what was expected.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace etlc::embed::worker {

struct Library {
    std::string path;
    std::string version;  ///< "1.30.0"
};

/// Loads the library `where`, or one in the folder `where`. An empty path stands for
/// ETLC_ONNXRUNTIME, or for what pip, npm or the system have installed.
Library load_onnxruntime(const std::string& where);

namespace ort {

// The types and functions of the C interface of ONNX Runtime 1.13: a table of functions, to whose
// end later releases only add. Earlier ones cut sums of quantised numbers (network.cpp).
// https://github.com/microsoft/onnxruntime/blob/v1.13.1/include/onnxruntime/core/session/onnxruntime_c_api.h
inline constexpr std::uint32_t kInterface = 13;

struct Status;
struct Environment;
struct Options;
struct Session;
struct Memory;
struct Tensor;
struct Shape;
struct RunOptions;
using Log = void (*)(void*, int, const char*, const char*, const char*, const char*);

inline constexpr int kInvalidProtobuf = 7;    // OrtErrorCode
inline constexpr int kFatal = 4;              // OrtLoggingLevel
inline constexpr int kAllOptimizations = 99;  // GraphOptimizationLevel
inline constexpr int kFloat = 1;              // ONNXTensorElementDataType
inline constexpr int kArena = 1, kUsual = 0;  // OrtAllocatorType, OrtMemType

/// The table of the loaded library.
using Function = void (*)();
const Function* table();

/// Returns the function at a place of the table.
template <std::size_t place, class Signature>
struct Call;
template <std::size_t place, class Result, class... Arguments>
struct Call<place, Result(Arguments...)> {
    Result operator()(Arguments... arguments) const {
        return reinterpret_cast<Result (*)(Arguments...)>(table()[place])(arguments...);
    }
};

inline constexpr Call<1, int(const Status*)> error_code;
inline constexpr Call<2, const char*(const Status*)> error_message;
inline constexpr Call<4, Status*(Log, void*, int, const char*, Environment**)> create_environment;
inline constexpr Call<8, Status*(const Environment*, const void*, std::size_t, const Options*,
                                 Session**)>
    create_session;
inline constexpr Call<9,
                      Status*(Session*, const RunOptions*, const char* const*, const Tensor* const*,
                              std::size_t, const char* const*, std::size_t, Tensor**)>
    run;
inline constexpr Call<10, Status*(Options**)> create_options;
inline constexpr Call<23, Status*(Options*, int)> set_optimization;
inline constexpr Call<24, Status*(Options*, int)> set_threads;
inline constexpr Call<49, Status*(const Memory*, void*, std::size_t, const std::int64_t*,
                                  std::size_t, int, Tensor**)>
    create_tensor;
inline constexpr Call<51, Status*(Tensor*, void**)> tensor_data;
inline constexpr Call<60, Status*(const Shape*, int*)> element_type;
inline constexpr Call<61, Status*(const Shape*, std::size_t*)> dimension_count;
inline constexpr Call<62, Status*(const Shape*, std::int64_t*, std::size_t)> dimensions;
inline constexpr Call<65, Status*(const Tensor*, Shape**)> shape_of;
inline constexpr Call<69, Status*(int, int, Memory**)> create_memory;
inline constexpr Call<92, void(Environment*)> release_environment;
inline constexpr Call<93, void(Status*)> release_status;
inline constexpr Call<94, void(Memory*)> release_memory;
inline constexpr Call<95, void(Session*)> release_session;
inline constexpr Call<96, void(Tensor*)> release_tensor;
inline constexpr Call<99, void(Shape*)> release_shape;
inline constexpr Call<100, void(Options*)> release_options;
inline constexpr Call<130, Status*(Options*, const char*, const char*)> configure;

}  // namespace ort

}  // namespace etlc::embed::worker
