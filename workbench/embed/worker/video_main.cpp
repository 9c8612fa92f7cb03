// etlc-embed-video: the only part that loads FFmpeg, whose libraries are many.
#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

namespace {

/// The words are those of etlc-embed behind "video".
void run(const std::vector<std::string>& words) {
    if (words.empty())
        refuse(recordings::frames::kWrongCall, "etlc-embed-video belongs to etlc-embed: FILE ...");
    limit_resources(recordings::frames::kMaxMemoryBytes);
    const Words options({words.begin() + 1, words.end()});
    if (options.text("--pace", "") == "live")
        send_live(words[0]);
    else
        send_video(words[0], options);
}

}  // namespace

}  // namespace etlc::embed::worker

int main(int argc, char** argv) {
    return etlc::embed::worker::guarded(argc, argv, etlc::embed::worker::run);
}
