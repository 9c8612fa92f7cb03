// etlc-embed and etlc-embed-video: decode images and video and run networks, in separate processes.
// Takes: the words of a call, and frames on standard input. Gives: frames or embeddings on standard
// output, by the protocol of recordings/frames/protocol.hpp. Keeps true: an error is one line on
// standard error and an exit status of that header; nothing is written after it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::embed::worker {

/// The program beside etlc-embed that decodes video.
inline constexpr std::string_view kVideoDecoder = "etlc-embed-video";

/// Prints the reason and ends the process.
[[noreturn]] void refuse(int exit_status, const std::string& why);

/// Writes to standard output; ends the process quietly where nobody reads it any more.
void write_out(const void* bytes, std::size_t size);
void write_number(std::uint32_t number);
/// Writes a frame: its head, then its pixels.
void write_frame(std::uint32_t height, std::uint32_t width, const std::uint8_t* rgb);

/// Reads `size` bytes; false at the end of standard input. Ends the process where the input is cut.
bool read_in(void* to, std::size_t size);

/// Limits the process, since a file may be damaged. `memory`: bytes; 0 for no limit, since models
/// are trusted.
void limit_resources(std::uint64_t memory);

/// Passes the words of a call to `run`, and refuses what it throws.
int guarded(int argc, char** argv, void (*run)(const std::vector<std::string>& words));

/// The options of a call, each with a value: "--rate 30".
class Words {
public:
    explicit Words(std::vector<std::string> words) : words_(std::move(words)) {}
    /// Return the value of `--NAME`, or `usual` where it is absent.
    std::vector<double> numbers(std::string_view name, std::vector<double> usual = {}) const;
    std::string text(std::string_view name, std::string usual) const;

private:
    std::vector<std::string> words_;
};

void send_images(const std::vector<std::string>& paths);
/// Decodes images whose bytes arrive on standard input.
void send_given_images();
/// Writes the frame on standard input as PNG.
void write_png();
void send_video(const std::string& path, const Words& options);
/// Decodes a camera, a stream or a pipe, each frame behind its time.
void send_live(const std::string& source);
void encode(const std::string& model, const Words& options);
/// Prints the version and the path of ONNX Runtime, a line each.
void say_onnxruntime(const Words& options);

}  // namespace etlc::embed::worker
