// Reads .h5 through the reader process: whatever the bytes do to libhdf5 there, the result is a
// valid trace or an error. Seeds named crashes_* are damaged files, found by changing bytes of
// trace.h5 at random, on which libhdf5 1.10.8 crashes.
#include <stdlib.h>
#include <unistd.h>

#include <string>

#include "fuzz_target.hpp"
#include "recordings/hdf5/hdf5.hpp"

namespace {

using namespace etlc;
using Kind = data::Channel::Kind;

/// A file that holds the bytes until the end of a run.
class HeldFile {
public:
    HeldFile(const std::uint8_t* bytes, std::size_t size) {
        const int descriptor = ::mkstemps(path_.data(), 3);
        fuzz::require(descriptor >= 0, "there is room for a temporary file");
        fuzz::require(::write(descriptor, bytes, size) == static_cast<ssize_t>(size),
                      "it takes the bytes");
        ::close(descriptor);
    }
    HeldFile(const HeldFile&) = delete;
    HeldFile& operator=(const HeldFile&) = delete;
    ~HeldFile() { ::unlink(path_.c_str()); }
    const std::string& path() const { return path_; }

private:
    std::string path_ = "/tmp/etlc_fuzz_XXXXXX.h5";
};

void list(const std::string& path) {
    const auto names = recordings::list_hdf5(path, "*/*");
    if (!names) return fuzz::require_printable(names.failure().message);
    for (const std::string& name : *names) fuzz::require_printable(name);
}

void step_through(const std::string& path, const std::vector<data::Channel>& channels) {
    auto trace = recordings::open_hdf5_trace(path, "", channels);
    if (!trace) return fuzz::require_printable(trace.failure().message);
    data::Sample sample;
    for (std::uint64_t steps = 0;; ++steps) {
        const auto more = (*trace)->next(sample);
        if (!more) return fuzz::require_printable(more.failure().message);
        if (!*more)
            return fuzz::require(steps == (*trace)->length(),
                                 "there are as many steps as announced");
        for (std::size_t c = 0; c < channels.size(); ++c)
            fuzz::require(sample.values[c].size() == channels[c].width,
                          "a sample is as wide as its channel");
        if (steps == 1000) return;  // a header may declare any number of zeros
    }
}

void look(const std::string& path) {
    auto images = recordings::open_hdf5_images(path, "", "", true);
    if (!images) return fuzz::require_printable(images.failure().message);
    recordings::Frame frame;
    for (int image = 0; image < 3; ++image) {
        const auto more = (*images)->next(frame);
        if (!more) return fuzz::require_printable(more.failure().message);
        if (!*more) return;
        fuzz::require(frame.rgb.size() == std::size_t{3} * frame.height * frame.width,
                      "an image is as large as it says");
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    static const int kReader = ::setenv("ETLC_HDF5_READER", ETLC_HDF5_READER_PATH, 1);
    fuzz::require(kReader == 0, "the environment takes the reader");
    const HeldFile file(bytes, size);
    list(file.path());
    look(file.path());
    step_through(file.path(), {{"z", Kind::vector, 2},
                               {"p", Kind::vector, 2},
                               {"g", Kind::scalar, 1},
                               {"b", Kind::boolean, 1},
                               {"truth.q", Kind::boolean, 1, true}});
    return 0;
}
