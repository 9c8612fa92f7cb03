#include "data/files/hash.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "data/files/file.hpp"
#include "etlmon/checksum.hpp"

namespace etlc::data {
namespace {

using namespace etlmon::detail;

std::uint64_t little_endian(const char* bytes, int n) {
    std::uint64_t result = 0;
    for (int i = 0; i < n; ++i)
        result |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
    return result;
}

/// Hashes whole stripes of 32 bytes; `bytes` keeps the rest.
std::uint64_t stripes(std::string_view& bytes, std::uint64_t seed) {
    const std::size_t whole = bytes.size() / 32 * 32;
    XxhLanes lanes(seed);
    lanes.add(reinterpret_cast<const std::uint8_t*>(bytes.data()), whole);
    bytes.remove_prefix(whole);
    return lanes.merged();
}

/// Hashes the rest after the stripes, fewer than 32 bytes, and mixes the result.
std::uint64_t finish(std::uint64_t hash, std::string_view bytes) {
    for (; bytes.size() >= 8; bytes.remove_prefix(8))
        hash = rotated(hash ^ xxh_round(0, little_endian(bytes.data(), 8)), 27) * kXxhPrime1 +
               kXxhPrime4;
    if (bytes.size() >= 4) {
        hash = rotated(hash ^ (little_endian(bytes.data(), 4) * kXxhPrime1), 23) * kXxhPrime2 +
               kXxhPrime3;
        bytes.remove_prefix(4);
    }
    for (; !bytes.empty(); bytes.remove_prefix(1))
        hash = rotated(hash ^ (little_endian(bytes.data(), 1) * kXxhPrime5), 11) * kXxhPrime1;
    return xxh_finish(hash);
}

void append(std::string& bytes, std::uint64_t value, int n) {
    for (int i = 0; i < n; ++i) bytes.push_back(static_cast<char>((value >> (8 * i)) & 0xff));
}

}  // namespace

std::string hash_text(std::uint64_t hash) {
    return fmt::format("{:016x}", hash);
}

std::optional<std::uint64_t> hash_of_text(std::string_view text) {
    const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    std::uint64_t hash = 0;
    if (text.size() != 16 || !std::all_of(text.begin(), text.end(), is_hex)) return std::nullopt;
    std::from_chars(text.data(), text.data() + text.size(), hash, 16);
    return hash;
}

std::uint64_t xxh64(std::string_view bytes, std::uint64_t seed) {
    const std::uint64_t length = bytes.size();
    const std::uint64_t hash = length >= 32 ? stripes(bytes, seed) : seed + kXxhPrime5;
    return finish(hash + length, bytes);
}

std::string content_hash(const std::vector<std::uint64_t>& shape,
                         const std::vector<float>& values) {
    constexpr std::size_t kPieceBytes = 1U << 16U;
    std::string bytes;
    append(bytes, shape.size(), 8);
    for (const std::uint64_t n : shape) append(bytes, n, 8);
    const std::uint64_t length = bytes.size() + 4 * values.size();
    XxhLanes lanes(0);
    for (const float value : values) {
        append(bytes, std::bit_cast<std::uint32_t>(value), 4);
        if (bytes.size() < kPieceBytes) continue;
        const std::size_t whole = bytes.size() / 32 * 32;
        lanes.add(reinterpret_cast<const std::uint8_t*>(bytes.data()), whole);
        bytes.erase(0, whole);
    }
    const std::size_t whole = bytes.size() / 32 * 32;
    lanes.add(reinterpret_cast<const std::uint8_t*>(bytes.data()), whole);
    const std::uint64_t hash = length >= 32 ? lanes.merged() : kXxhPrime5;
    return fmt::format("{:016x}", finish(hash + length, std::string_view(bytes).substr(whole)));
}

diag::Result<std::string> hash_of_file(const std::string& path, diag::Code code) {
    if (auto why = why_unreadable(path)) return diag::Failure{code, *why};
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file) return diag::Failure{code, error_words(errno)};
    constexpr std::size_t kPieceBytes = 1U << 20U;  // whole stripes
    std::string piece(kPieceBytes, '\0');
    XxhLanes lanes(0);
    std::uint64_t length = 0;
    std::size_t filled = 0;
    for (;;) {
        const ssize_t got = uninterrupted(
            [&] { return ::read(*file, piece.data() + filled, kPieceBytes - filled); });
        if (got < 0) return diag::Failure{code, error_words(errno)};
        filled += static_cast<std::size_t>(got);
        length += static_cast<std::uint64_t>(got);
        if (got > 0 && filled < kPieceBytes) continue;
        const std::size_t whole = filled / 32 * 32;
        lanes.add(reinterpret_cast<const std::uint8_t*>(piece.data()), whole);
        if (got == 0) {
            const std::uint64_t hash = length >= 32 ? lanes.merged() : kXxhPrime5;
            const std::string_view rest(piece.data() + whole, filled - whole);
            return fmt::format("{:016x}", finish(hash + length, rest));
        }
        filled = 0;
    }
}

std::string ends_of_file(const std::string& path) {
    constexpr std::uintmax_t kEnd = 1U << 12U;
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    std::ifstream file(path, std::ios::binary);
    if (error || !file) return {};
    std::string bytes = std::to_string(size) + ' ';
    const auto add = [&](std::uintmax_t from) {
        std::string end(std::min(kEnd, size - from), '\0');
        file.seekg(static_cast<std::streamoff>(from));
        file.read(end.data(), static_cast<std::streamsize>(end.size()));
        bytes += end;
    };
    add(0);
    add(size > kEnd ? size - kEnd : 0);
    return bytes;
}

}  // namespace etlc::data
