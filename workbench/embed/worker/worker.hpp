// etlc-embed: what touches images, video and networks, in a process of its own.
// Takes: the words of a call, and frames on standard input. Gives: frames or embeddings on standard
// output, in the form of data/frames/protocol.hpp. Keeps true: what goes wrong is one line on
// standard error and an exit status of that header; nothing is written after it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::embed::worker {

/// Says why, and ends the process.
[[noreturn]] void refuse(int exit_status, const std::string& why);

/// Ends the process quietly where nobody reads any more.
void write_out(const void* bytes, std::size_t size);
void write_number(std::uint32_t number);
/// Its head; the pixels follow.
void write_frame(std::uint32_t height, std::uint32_t width, const std::uint8_t* rgb);

/// False at the end of standard input; ends the process where it ends in the middle.
bool read_in(void* to, std::size_t size);

/// The options of a call, "--rate 30": each with a value.
class Words {
public:
    explicit Words(std::vector<std::string> words) : words_(std::move(words)) {}
    /// Of `--NAME`; `usual` where it is absent.
    std::vector<double> numbers(std::string_view name, std::vector<double> usual = {}) const;
    std::string text(std::string_view name, std::string usual) const;

private:
    std::vector<std::string> words_;
};

void send_images(const std::vector<std::string>& paths);
/// Those whose bytes come on standard input.
void send_given_images();
void send_video(const std::string& path, const Words& options);
void encode(const std::string& model, const Words& options);
/// Writes the version of the library that runs networks, and its path, on a line each.
void say_onnxruntime(const Words& options);

}  // namespace etlc::embed::worker
