#include "data/arrays/array.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data/arrays/archive.hpp"
#include "data/arrays/elements.hpp"
#include "data/arrays/npy_header.hpp"
#include "data/files/file.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {

namespace {

using diag::Code;
using diag::Failure;

constexpr std::size_t kChunk = 1U << 14U;  ///< elements

/// Reads the values in the order of the file.
diag::Result<std::vector<double>> read_values(ByteSource& source, const NpyHeader& header) {
    const std::size_t width = info(header.element).bytes;
    std::vector<double> values;
    std::vector<char> bytes(kChunk * width);
    while (values.size() < header.count) {
        const auto n =
            static_cast<std::size_t>(std::min<std::uint64_t>(kChunk, header.count - values.size()));
        const auto got = source.read(bytes.data(), n * width);
        if (!got) return got.failure();
        if (*got < n * width)
            return *check_size(header, header.header_bytes + values.size() * width + *got);
        const std::size_t before = values.size();
        values.resize(before + n);
        const std::size_t sound = decode(header.element, bytes.data(), n, values.data() + before);
        if (sound < n)
            return Failure{Code::malformed_array,
                           fmt::format("has the byte {} as bool element {}, expected 0 or 1",
                                       static_cast<unsigned char>(bytes[sound]), before + sound)};
    }
    // An archive compares its checksum at the end.
    const auto more = source.read(bytes.data(), 1);
    if (!more) return more.failure();
    if (*more > 0) return *check_size(header, header.header_bytes + header.data_bytes() + *more);
    return values;
}

/// Converts column-major to row-major, for any rank.
std::vector<double> row_major(const std::vector<double>& values,
                              const std::vector<std::uint64_t>& shape) {
    std::vector<std::uint64_t> strides(shape.size(), 1);
    for (std::size_t d = 1; d < shape.size(); ++d) strides[d] = strides[d - 1] * shape[d - 1];
    std::vector<std::uint64_t> index(shape.size(), 0);
    std::vector<double> result;
    result.reserve(values.size());
    std::uint64_t at = 0;
    while (result.size() < values.size()) {
        result.push_back(values[at]);
        for (std::size_t d = shape.size(); d-- > 0;) {
            at += strides[d];
            if (++index[d] < shape[d]) break;
            at -= strides[d] * shape[d];
            index[d] = 0;
        }
    }
    return result;
}

}  // namespace

diag::Result<Array> read_npy_from(ByteSource& source) {
    const auto header = read_npy_header(source);
    if (!header) return header.failure();
    if (auto failure = check_size(*header, source.size())) return *failure;
    if (header->count > kMaxArrayElements)
        return Failure{Code::array_too_large,
                       fmt::format("shape {} has {} elements, at most {} are read",
                                   shape_text(header->shape), header->count, kMaxArrayElements)};
    auto values = read_values(source, *header);
    if (!values) return values.failure();
    Array array{header->shape, header->element, std::move(*values)};
    if (header->fortran_order && array.shape.size() > 1)
        array.values = row_major(array.values, array.shape);
    return array;
}

diag::Failure in_array(const Failure& failure, const std::string& key) {
    return {failure.code, fmt::format("array {}: {}", in_quotes(key), failure.message),
            failure.line, failure.column};
}

std::string Array::shape_text() const {
    return data::shape_text(shape);
}

diag::Result<Array> read_npy(const std::string& path) {
    auto source = open_file(path);
    if (!source) return source.failure();
    return read_npy_from(**source);
}

diag::Result<Array> parse_npy(std::string_view bytes) {
    return read_npy_from(*from_memory(bytes));
}

namespace {

using diag::Code;
using diag::Failure;

/// Returns the requested key; without one, the only key.
diag::Result<std::string> choose(const Archive& archive, const std::string& key) {
    if (!key.empty()) return key;
    if (archive.keys().empty()) return Failure{Code::no_such_array, "holds no arrays"};
    if (archive.keys().size() > 1)
        return Failure{Code::no_such_array,
                       fmt::format("holds {} arrays, {}; expected the key of one of them",
                                   archive.keys().size(), listed(archive.keys()))};
    return archive.keys().front();
}

diag::Result<Array> read_from(const ArchivePlace& place, const std::string& key) {
    const auto archive = Archive::open(place);
    if (!archive) return archive.failure();
    const auto chosen = choose(*archive, key);
    if (!chosen) return chosen.failure();
    const auto member = archive->member(*chosen);
    if (!member) return member.failure();
    auto array = read_npy_from(**member);
    if (!array) return in_array(array.failure(), *chosen);
    return array;
}

}  // namespace

diag::Result<Array> read_npz(const std::string& path, const std::string& key) {
    return read_from({path, {}, false}, key);
}

diag::Result<Array> parse_npz(std::string_view bytes, const std::string& key) {
    return read_from({{}, bytes, true}, key);
}

diag::Result<Array> read_array(const std::string& path, const std::string& key) {
    if (path.ends_with(".npz")) return within_memory([&] { return read_npz(path, key); });
    if (!path.ends_with(".npy"))
        return Failure{Code::unknown_data_format,
                       "unknown kind of data file, expected .npy or .npz"};
    if (!key.empty())
        return Failure{
            Code::key_without_archive,
            fmt::format("an .npy file holds one array without a name, so the key {} has no meaning",
                        in_quotes(key))};
    return within_memory([&] { return read_npy(path); });
}

}  // namespace etlc::data
