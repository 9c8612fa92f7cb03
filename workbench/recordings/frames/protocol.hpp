// The protocol of etlc-embed and of encoder commands.
//
// Frames, on the standard output of `etlc-embed video FILE ...`, `etlc-embed images FILE...` and
// `etlc-embed given`, and the standard input of encoders: for each frame its height and width, 32
// bits each, then height x width x 3 bytes; with `--pace`, in front of these, the microseconds of
// the machine's steady clock, 64 bits. Images, on the standard input of `etlc-embed given`: for
// each the size of its file, 32 bits, then the bytes of the file. The bytes of a PNG file, on the
// standard output of `etlc-embed png`, which reads one frame. Embeddings, on the standard output of
// encoders: once their dimension, 32 bits, then for every frame as many float32. The version and
// the path of ONNX Runtime, a line each, on the standard output of `etlc-embed onnxruntime`. All
// numbers are little-endian. The last line of standard error explains a failure.
#pragma once

#include <cstdint>
#include <string>

namespace etlc::recordings::frames {

inline constexpr std::uint32_t kMaxExtent = 1U << 14U;       ///< rows or columns
inline constexpr std::uint64_t kMaxPixels = 1ULL << 26U;     ///< of a frame
inline constexpr std::uint32_t kMaxImageBytes = 64U << 20U;  ///< of an image on standard input
inline constexpr std::uint32_t kMaxDimension = 1U << 20U;

/// Exit statuses of etlc-embed, besides 0.
enum Exit : int {
    kWrongCall = 64,
    kRefused = 65,      ///< the image, video or model is refused
    kOutOfStep = 66,    ///< the frame rate does not fit the rate of the spec
    kNoSuchFrame = 67,  ///< the video has fewer frames than are wanted
    kNoRuntime = 68,    ///< ONNX Runtime is missing, or another library
    kOtherCount = 69    ///< the video has more or fewer frames than it must have
};

// Limits of the decoder. An ordinary file needs a small part of them.
inline constexpr std::uint64_t kMaxMemoryBytes = 4ULL << 30U;  ///< address space
inline constexpr int kMaxSilenceSeconds = 120;                 ///< of the clock, between two frames

/// Writes and reads a number of 32 bits.
inline void append(std::string& bytes, std::uint32_t value) {
    for (unsigned shift = 0; shift < 32; shift += 8)
        bytes += static_cast<char>((value >> shift) & 0xffU);
}
inline std::uint32_t number_at(const char* bytes) {
    std::uint32_t result = 0;
    for (unsigned i = 0; i < 4; ++i)
        result |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
    return result;
}

}  // namespace etlc::recordings::frames
