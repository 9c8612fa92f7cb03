// etlc-embed: everything but video.
#include <unistd.h>

#include <filesystem>

#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

namespace {

using namespace recordings::frames;
using Strings = std::vector<std::string>;

/// Replaces this process by the program beside it that decodes video.
void become_video_decoder(const Strings& words) {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    const std::string program = self.parent_path() / kVideoDecoder;
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(program.c_str(), arguments.data());
    refuse(kRefused, program +
                         ", which decodes video, cannot be run: the Debian package etlc-embed "
                         "has it");
}

void run(const Strings& words) {
    const std::string command = words.empty() ? "" : words[0];
    const auto rest = [&](std::size_t from) {
        return Strings(words.begin() + static_cast<std::ptrdiff_t>(from), words.end());
    };
    if (command == "images") {
        limit_resources(kMaxMemoryBytes);
        send_images(rest(1));
    } else if (command == "given") {
        limit_resources(kMaxMemoryBytes);
        send_given_images();
    } else if (command == "png") {
        write_png();
    } else if (command == "video") {
        become_video_decoder(words);
    } else if (command == "encode" && words.size() >= 2) {
        limit_resources(0);
        encode(words[1], Words(rest(2)));
    } else if (command == "onnxruntime") {
        say_onnxruntime(Words(rest(1)));
    } else {
        refuse(kWrongCall,
               "etlc-embed belongs to etlc: etlc-embed images FILE..., etlc-embed given, "
               "etlc-embed png, etlc-embed video FILE, etlc-embed encode MODEL.onnx, etlc-embed "
               "onnxruntime");
    }
}

}  // namespace

}  // namespace etlc::embed::worker

int main(int argc, char** argv) {
    return etlc::embed::worker::guarded(argc, argv, etlc::embed::worker::run);
}
