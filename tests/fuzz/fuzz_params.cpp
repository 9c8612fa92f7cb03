// Reads parameters of a retargetable class: ready only if every byte is right; with a corrected
// checksum, only if all numbers are valid.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>

#include "etlmon/params/params.hpp"
#include "fuzz_target.hpp"

namespace {

/// A threshold on a distance, another threshold, two directions, a metric and a diagonal.
struct Layout {
    static constexpr std::uint64_t kShape = 0x0123456789abcdefU;
    static constexpr std::uint64_t kEncoder = 0x42U;
    static constexpr std::size_t kSize = 320;
    static constexpr etlmon::ParamsPart kParts[] = {
        {16, 1, 1, etlmon::ParamsPart::not_negative}, {17, 1, 1, etlmon::ParamsPart::any},
        {32, 6, 3, etlmon::ParamsPart::unit_rows},    {48, 4, 2, etlmon::ParamsPart::symmetric},
        {64, 2, 2, etlmon::ParamsPart::positive},
    };
};
using Params = etlmon::Params<Layout>;
constexpr std::size_t kSize = Layout::kSize;
constexpr std::size_t kChecksum = 56;

void seal(std::uint8_t* bytes) {
    const std::uint64_t sum = etlmon::detail::params_checksum(bytes, kSize);
    std::memcpy(bytes + kChecksum, &sum, sizeof sum);
}

struct Right {
    alignas(64) std::uint8_t bytes[kSize] = {};
    Right() {
        etlmon::detail::ParamsHead head{{}, 1, kSize, Layout::kShape, Layout::kEncoder, 1, 2, 3, 0};
        std::memcpy(head.magic, etlmon::detail::kParamsMagic, sizeof head.magic);
        std::memcpy(bytes, &head, sizeof head);
        const auto put = [&](std::size_t at, std::initializer_list<float> numbers) {
            std::memcpy(bytes + 4 * at, numbers.begin(), 4 * numbers.size());
        };
        put(16, {0.25F, -1.5F});
        put(32, {0.6F, 0.8F, 0, 0, 0, -1});
        put(48, {2, 0.5F, 0.5F, 1});
        put(64, {1, 3});
        seal(bytes);
    }
};

float number(const std::uint8_t* bytes, std::size_t at) {
    float x = 0;
    std::memcpy(&x, bytes + 4 * at, sizeof x);
    return x;
}

/// Computes in double with the standard library, unlike the runtime.
bool can_be(const std::uint8_t* bytes) {
    for (const std::size_t at :
         {16U, 17U, 32U, 33U, 34U, 35U, 36U, 37U, 48U, 49U, 50U, 51U, 64U, 65U})
        if (!std::isfinite(number(bytes, at))) return false;
    for (const std::size_t row : {32U, 35U}) {
        double square = 0;
        for (std::size_t i = 0; i < 3; ++i)
            square += std::pow(static_cast<double>(number(bytes, row + i)), 2);
        if (std::abs(square - 1) > 0.004) return false;
    }
    return number(bytes, 16) >= 0 && number(bytes, 48) > 0 && number(bytes, 51) > 0 &&
           number(bytes, 49) == number(bytes, 50) && number(bytes, 64) > 0 && number(bytes, 65) > 0;
}

}  // namespace

/// The first byte gives the address, relative to a multiple of 64, and whether the checksum is
/// corrected. The rest are bytes to combine with the right ones by exclusive or.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace fuzz = etlc::fuzz;
    if (size == 0) return 0;
    static const Right kRight;
    const std::size_t shift = data[0] % 64, count = std::min(size - 1, 2 * kSize);
    const bool sealed = (data[0] & 64U) != 0 && count == kSize;
    alignas(64) static std::uint8_t place[64 + 2 * kSize];
    std::uint8_t* const bytes = place + shift;
    for (std::size_t i = 0; i < count; ++i)
        bytes[i] = static_cast<std::uint8_t>(kRight.bytes[i % kSize] ^ data[1 + i]);
    if (sealed) seal(bytes);
    const bool is_right = count == kSize && std::memcmp(bytes, kRight.bytes, kSize) == 0;
    const Params params(bytes, count);
    fuzz::require(!is_right || shift != 0 || params.ready(), "the right bytes are ready");
    if (!sealed) fuzz::require(params.ready() == (is_right && shift == 0), "no others are");
    if (params.ready()) {
        fuzz::require(std::memcmp(bytes, kRight.bytes, 32) == 0, "the head is that of the class");
        fuzz::require(can_be(bytes), "every number can be what it stands for");
    }
    fuzz::require((params.numbers() != nullptr) == params.ready(), "numbers of what is ready");
    fuzz::require_printable(etlmon::words(params.state()));
    return 0;
}
