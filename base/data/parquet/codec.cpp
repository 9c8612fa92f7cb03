#include "data/parquet/codec.hpp"

#include <snappy.h>
#include <zstd.h>

#include "data/parquet/cursor.hpp"

namespace etlc::data::parquet {
namespace {

enum Codec : std::int64_t { kUncompressed = 0, kSnappy = 1, kZstd = 6 };

[[noreturn]] void damaged() {
    refuse("is damaged: a page of it cannot be unpacked");
}

void check_size(std::uint64_t found, std::uint64_t claimed) {
    if (found != claimed)
        refuse("has a page that claims " + std::to_string(claimed) + " bytes and unpacks to " +
               std::to_string(found));
}

}  // namespace

void check_codec(std::int64_t codec) {
    if (codec == kUncompressed || codec == kSnappy || codec == kZstd) return;
    static const char* const kNames[] = {"", "", "GZIP", "LZO", "BROTLI", "LZ4", "", "LZ4_RAW"};
    const bool known = codec >= 0 && codec < 8;
    refuse("is packed by " +
           (known ? std::string(kNames[codec]) : "the codec " + std::to_string(codec)) +
           ", expected UNCOMPRESSED, SNAPPY or ZSTD");
}

std::string unpacked(std::int64_t codec, std::string_view packed, std::uint64_t size) {
    if (size > kMaxPageBytes)
        refuse("has a page that claims " + std::to_string(size) + " bytes, at most " +
               std::to_string(kMaxPageBytes) + " are read");
    std::string bytes;
    if (size == 0 && packed.empty()) return bytes;  // of nulls only, whatever the codec
    if (codec == kSnappy) {
        std::size_t found = 0;
        if (!snappy::GetUncompressedLength(packed.data(), packed.size(), &found)) damaged();
        check_size(found, size);
        bytes.resize(size);
        if (!snappy::RawUncompress(packed.data(), packed.size(), bytes.data())) damaged();
        return bytes;
    }
    if (codec == kZstd) {
        bytes.resize(size);
        const std::size_t found =
            ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
        if (ZSTD_isError(found) != 0) damaged();
        check_size(found, size);
        return bytes;
    }
    check_size(packed.size(), size);
    return std::string(packed);
}

}  // namespace etlc::data::parquet
