#include "data/hash.hpp"

#include <fmt/format.h>

#include <bit>
#include <string>
#include <vector>

#include "data/array.hpp"

namespace etlc::data {
namespace {

constexpr std::uint64_t kPrime1 = 0x9E3779B185EBCA87;
constexpr std::uint64_t kPrime2 = 0xC2B2AE3D27D4EB4F;
constexpr std::uint64_t kPrime3 = 0x165667B19E3779F9;
constexpr std::uint64_t kPrime4 = 0x85EBCA77C2B2AE63;
constexpr std::uint64_t kPrime5 = 0x27D4EB2F165667C5;

std::uint64_t little_endian(const char* bytes, int n) {
    std::uint64_t result = 0;
    for (int i = 0; i < n; ++i) result |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
    return result;
}

std::uint64_t round(std::uint64_t accumulator, std::uint64_t lane) {
    return std::rotl(accumulator + lane * kPrime2, 31) * kPrime1;
}

std::uint64_t merge(std::uint64_t hash, std::uint64_t accumulator) {
    return (hash ^ round(0, accumulator)) * kPrime1 + kPrime4;
}

/// Whole stripes of 32 bytes, four lanes side by side; `bytes` keeps what is left.
std::uint64_t stripes(std::string_view& bytes, std::uint64_t seed) {
    std::uint64_t a = seed + kPrime1 + kPrime2;
    std::uint64_t b = seed + kPrime2;
    std::uint64_t c = seed;
    std::uint64_t d = seed - kPrime1;
    for (; bytes.size() >= 32; bytes.remove_prefix(32)) {
        a = round(a, little_endian(bytes.data(), 8));
        b = round(b, little_endian(bytes.data() + 8, 8));
        c = round(c, little_endian(bytes.data() + 16, 8));
        d = round(d, little_endian(bytes.data() + 24, 8));
    }
    const std::uint64_t hash = std::rotl(a, 1) + std::rotl(b, 7) + std::rotl(c, 12) + std::rotl(d, 18);
    return merge(merge(merge(merge(hash, a), b), c), d);
}

void append(std::string& bytes, std::uint64_t value, int n) {
    for (int i = 0; i < n; ++i) bytes.push_back(static_cast<char>((value >> (8 * i)) & 0xff));
}

}  // namespace

std::uint64_t xxh64(std::string_view bytes, std::uint64_t seed) {
    const std::uint64_t length = bytes.size();
    std::uint64_t hash = length >= 32 ? stripes(bytes, seed) : seed + kPrime5;
    hash += length;
    for (; bytes.size() >= 8; bytes.remove_prefix(8))
        hash = std::rotl(hash ^ round(0, little_endian(bytes.data(), 8)), 27) * kPrime1 + kPrime4;
    if (bytes.size() >= 4) {
        hash = std::rotl(hash ^ (little_endian(bytes.data(), 4) * kPrime1), 23) * kPrime2 + kPrime3;
        bytes.remove_prefix(4);
    }
    for (; !bytes.empty(); bytes.remove_prefix(1))
        hash = std::rotl(hash ^ (little_endian(bytes.data(), 1) * kPrime5), 11) * kPrime1;
    hash = (hash ^ (hash >> 33)) * kPrime2;
    hash = (hash ^ (hash >> 29)) * kPrime3;
    return hash ^ (hash >> 32);
}

std::string content_hash(const std::vector<std::uint64_t>& shape, const std::vector<float>& values) {
    std::string bytes;
    bytes.reserve(8 * (shape.size() + 1) + 4 * values.size());
    append(bytes, shape.size(), 8);
    for (const std::uint64_t n : shape) append(bytes, n, 8);
    for (const float value : values) append(bytes, std::bit_cast<std::uint32_t>(value), 4);
    return fmt::format("{:016x}", xxh64(bytes));
}

}  // namespace etlc::data
