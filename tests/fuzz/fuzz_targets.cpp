// Reads a file of targets: ready only if the bytes are right and at a right address.
#include <algorithm>
#include <cstring>

#include "etlmon/distance/targets.hpp"
#include "fuzz_target.hpp"

namespace {

constexpr std::size_t kSize = 256;
using Targets = etlmon::Targets<kSize, 0xc12570868ceac336u>;

}  // namespace

/// The first byte gives the address, relative to a multiple of 64. The rest are bytes to combine
/// with the right ones by exclusive or.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace fuzz = etlc::fuzz;
    if (size == 0) return 0;
    const std::size_t shift = data[0] % 64, count = std::min(size - 1, 2 * kSize);
    alignas(64) static std::uint8_t place[64 + 2 * kSize];
    bool right = count == kSize && shift == 0;
    for (std::size_t i = 0; i < count; ++i) {
        place[shift + i] = static_cast<std::uint8_t>((i * 37 + 1) ^ data[1 + i]);
        right = right && data[1 + i] == 0;
    }
    const Targets targets(place + shift, count);
    fuzz::require(targets.ready() == right, "the right bytes are ready, others are not");
    fuzz::require((targets.rows() != nullptr) == right, "rows are handed out where they are ready");
    fuzz::require_printable(etlmon::words(targets.state()));
    return 0;
}
