// Reads .csv traces: any bytes give steps of the requested channels, or an error with a place.
#include <cmath>

#include "data/traces/trace_formats.hpp"
#include "fuzz_target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    using namespace etlc;
    using Kind = data::Channel::Kind;
    const std::vector<data::Channel> channels{
        {"z", Kind::vector, 2}, {"g", Kind::scalar, 1}, {"b", Kind::boolean, 1}};
    auto trace = data::open_csv_trace(data::from_memory(fuzz::text(bytes, size)), channels);
    if (!trace) {
        fuzz::require_printable(trace.failure().message);
        return 0;
    }
    data::Sample sample;
    for (std::size_t steps = 0;; ++steps) {
        const auto more = (*trace)->next(sample);
        if (!more) fuzz::require_printable(more.failure().message);
        if (!more || !*more) return 0;
        fuzz::require(steps < size, "there is no step without a byte");
        for (std::size_t c = 0; c < channels.size(); ++c) {
            fuzz::require(sample.values[c].size() == channels[c].width,
                          "a sample is as wide as its channel");
            for (const double value : sample.values[c]) {
                fuzz::require(!std::isinf(value), "what is not finite is NaN");
                fuzz::require(sample.present[c] || std::isnan(value),
                              "what is missing has no number");
            }
        }
        const double b = sample.values[2][0];
        fuzz::require(std::isnan(b) || b == 0 || b == 1, "a bool is 0 or 1");
    }
}
