// Reads .npz, as an array and as a trace.
#include "data/arrays/array.hpp"
#include "data/traces/trace_formats.hpp"
#include "fuzz_target.hpp"

namespace {

using namespace etlc;
using Kind = data::Channel::Kind;

void load(const std::string& path) {
    for (const char* key : {"", "z", "g"}) {
        const auto array = data::read_npz(path, key);
        if (!array) {
            fuzz::require_printable(array.failure().message);
            continue;
        }
        std::uint64_t count = 1;
        for (const std::uint64_t n : array->shape) count *= n;
        fuzz::require(array->values.size() == count,
                      "the number of values is the product of the shape");
    }
}

void step_through(const std::string& path, const std::vector<data::Channel>& channels) {
    auto trace = data::open_npz_trace(path, channels);
    if (!trace) return fuzz::require_printable(trace.failure().message);
    data::Sample sample;
    for (std::uint64_t steps = 0;; ++steps) {
        const auto more = (*trace)->next(sample);
        if (!more) return fuzz::require_printable(more.failure().message);
        if (!*more)
            return fuzz::require(steps == (*trace)->length(),
                                 "there are as many steps as announced");
        fuzz::require(sample.values.size() == channels.size(), "every channel has its values");
        for (std::size_t c = 0; c < channels.size(); ++c)
            fuzz::require(sample.values[c].size() == channels[c].width,
                          "a sample is as wide as its channel");
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const fuzz::File file(fuzz::text(bytes, size));
    load(file.path());
    step_through(file.path(), {{"z", Kind::vector, 2}});
    step_through(file.path(),
                 {{"z", Kind::vector, 2}, {"g", Kind::scalar, 1}, {"b", Kind::boolean, 1}});
    return 0;
}
