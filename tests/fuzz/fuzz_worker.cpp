// Reads the output of etlc-embed and of encoders: whatever they write, and however they end, the
// result is valid frames and embeddings or an error. The first byte is the exit status of the
// program that writes the others. The bytes are also read as an ONNX model, and as an episode's
// record of its encoder.
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <string>

#include "artifacts/embedded.hpp"
#include "data/arrays/archive.hpp"
#include "embed/encoder.hpp"
#include "embed/worker/onnx.hpp"
#include "fuzz_target.hpp"
#include "recordings/frames/frames.hpp"
#include "recordings/frames/protocol.hpp"

namespace {

using namespace etlc;

constexpr int kSilence = 5;  // seconds

/// Files for a run, and the program that writes one of them.
class Folder {
public:
    Folder() {
        fuzz::require(::mkdtemp(path_.data()) != nullptr, "there is room for a temporary folder");
        std::ofstream(program()) << "#!/bin/sh\n"
                                    "tail -c +2 \"$2\"\n"
                                    "tail -c 40 \"$2\" >&2\n"
                                    "exit $(head -c 1 \"$2\" | od -A n -t u1)\n";
        ::chmod(program().c_str(), 0700);
        ::setenv("ETLC_EMBEDDER", program().c_str(), 1);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
        for (const std::string& file : {program(), bytes(), episode()}) ::unlink(file.c_str());
        ::rmdir(path_.c_str());
    }
    std::string program() const { return path_ + "/program"; }
    std::string bytes() const { return path_ + "/bytes"; }
    std::string episode() const { return path_ + "/episode.npz"; }

private:
    std::string path_ = "/tmp/etlc_fuzz_XXXXXX";
};

void read_frames(const std::string& path) {
    auto frames = recordings::open_images({path});
    fuzz::require(static_cast<bool>(frames), "the program is started");
    recordings::Frame frame;
    for (;;) {
        const auto more = (*frames)->next(frame);
        if (!more) return fuzz::require_printable(more.failure().message);
        if (!*more) return;
        const std::uint64_t pixels = std::uint64_t{frame.height} * frame.width;
        fuzz::require(pixels > 0 && pixels <= recordings::frames::kMaxPixels,
                      "a frame has its limits");
        fuzz::require(frame.rgb.size() == 3 * pixels, "a frame has all its pixels");
    }
}

/// Makes this many frames of one pixel.
class Pixels final : public recordings::FrameSource {
public:
    explicit Pixels(std::uint64_t count) : left_(count) {}
    diag::Result<bool> next(recordings::Frame& frame) override {
        frame = {1, 1, "rgb"};
        return left_-- > 0;
    }

private:
    std::uint64_t left_;
};

void read_embeddings(const Folder& folder) {
    check::Encoder encoder;
    encoder.name = "e";
    const std::string command = folder.program() + " encode " + folder.bytes();
    auto running = embed::Encoder::start(encoder, "m", {command, kSilence});
    fuzz::require(static_cast<bool>(running), "the command is started");
    constexpr std::uint64_t kFrames[] = {2, 1};
    std::size_t done = 0;
    for (const std::uint64_t count : kFrames) {
        Pixels frames(count);
        const auto trouble =
            (*running)->add(frames, "f", [&, count](const std::vector<float>& rows) {
                ++done;
                fuzz::require(rows.size() == count * (*running)->dimension(), "a row a frame");
                for (const float x : rows) fuzz::require(std::isfinite(x), "all are finite");
            });
        if (trouble) return fuzz::require_printable(trouble->failure.message);
    }
    if (const auto trouble = (*running)->finish())
        return fuzz::require_printable(trouble->failure.message);
    fuzz::require(done == std::size(kFrames), "all embeddings are given");
}

void read_marks(const Folder& folder, const std::string& bytes) {
    std::ofstream(folder.episode(), std::ios::binary)
        << data::npz_bytes({{"embedded.json", bytes}});
    const auto marks = embedded::read_marks(folder.episode());
    if (!marks) return fuzz::require_printable(marks.failure().message);
    std::ofstream(folder.episode(), std::ios::binary)
        << data::npz_bytes({{"embedded.json", embedded::write_marks(*marks)}});
    const auto again = embedded::read_marks(folder.episode());
    fuzz::require(again && *again == *marks, "writing what was read changes nothing");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    static const Folder kFolder;
    const std::string text(fuzz::text(bytes, size));
    std::ofstream(kFolder.bytes(), std::ios::binary) << text;
    read_frames(kFolder.bytes());
    read_embeddings(kFolder);
    read_marks(kFolder, text);
    if (const auto model = embed::worker::interface_of(text))
        fuzz::require(!model->outputs.empty(), "a model gives something");
    return 0;
}
