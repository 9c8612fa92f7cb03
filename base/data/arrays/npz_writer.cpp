#include "data/arrays/npz_writer.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <bit>
#include <memory>
#include <new>
#include <string_view>

#include "data/arrays/npy_header.hpp"

namespace etlc::data {
namespace {

struct Discard {
    void operator()(zip_t* archive) const { zip_discard(archive); }
    void operator()(zip_source_t* source) const { zip_source_free(source); }
};

/// Writing to memory fails only where memory runs out.
void require(bool done) {
    if (!done) throw std::bad_alloc();
}

void add(zip_t* archive, const ArchiveMember& member) {
    constexpr zip_uint16_t kFirstDay = (1U << 5U) | 1U;  // 1980-01-01, the first that zip can tell
    zip_source_t* source = zip_source_buffer(archive, member.bytes.data(), member.bytes.size(), 0);
    require(source != nullptr);
    const zip_int64_t index = zip_file_add(archive, member.name.c_str(), source, 0);
    if (index < 0) zip_source_free(source);
    require(index >= 0);
    const auto at = static_cast<zip_uint64_t>(index);
    require(zip_set_file_compression(archive, at, ZIP_CM_STORE, 0) == 0);
    require(zip_file_set_dostime(archive, at, 0, kFirstDay, 0) == 0);
}

std::string bytes_of(zip_source_t* source) {
    zip_stat_t status;
    zip_stat_init(&status);
    require(zip_source_stat(source, &status) == 0 && zip_source_open(source) == 0);
    std::string bytes(status.size, '\0');
    const zip_int64_t got = zip_source_read(source, bytes.data(), bytes.size());
    zip_source_close(source);
    require(got == static_cast<zip_int64_t>(bytes.size()));
    return bytes;
}

/// Returns the head of a .npy file. `element`: the type code of numpy, "<f4".
std::string npy_head(std::string_view element, const std::vector<std::uint64_t>& shape) {
    constexpr std::size_t kAlignment = 64;
    constexpr std::size_t kPreamble = 10;  // magic word, version, length of the header
    std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}",
                                     element, shape_text(shape));
    header.append(kAlignment - (kPreamble + header.size() + 1) % kAlignment, ' ');
    header += '\n';
    std::string bytes{"\x93NUMPY\x01\x00", 8};
    bytes += static_cast<char>(header.size() & 0xffU);
    bytes += static_cast<char>(header.size() >> 8U);
    bytes += header;
    return bytes;
}

}  // namespace

std::string npy_bytes(const std::vector<std::uint64_t>& shape, const std::vector<float>& values) {
    std::string bytes = npy_head("<f4", shape);
    bytes.reserve(bytes.size() + 4 * values.size());
    for (const float value : values) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (unsigned shift = 0; shift < 32; shift += 8)
            bytes += static_cast<char>((bits >> shift) & 0xffU);
    }
    return bytes;
}

std::string npy_of_uint8(const std::vector<std::uint64_t>& shape,
                         const std::vector<std::uint8_t>& values) {
    return npy_head("|u1", shape).append(values.begin(), values.end());
}

std::string npz_bytes(const std::vector<ArchiveMember>& members) {
    zip_error_t error;
    zip_error_init(&error);
    const std::unique_ptr<zip_source_t, Discard> source(
        zip_source_buffer_create(nullptr, 0, 0, &error));
    require(source != nullptr);
    std::unique_ptr<zip_t, Discard> archive(
        zip_open_from_source(source.get(), ZIP_TRUNCATE, &error));
    require(archive != nullptr);
    zip_source_keep(source.get());  // the archive takes one hold of it, we keep ours
    for (const ArchiveMember& member : members) add(archive.get(), member);
    require(zip_close(archive.get()) == 0);
    static_cast<void>(archive.release());  // closed
    zip_error_fini(&error);
    return bytes_of(source.get());
}

}  // namespace etlc::data
