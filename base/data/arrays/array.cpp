#include "data/arrays/array.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "data/arrays/archive.hpp"
#include "data/files/file.hpp"
#include "data/text/text.hpp"

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

namespace {

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

}  // namespace

diag::Result<Array> read_npz(const std::string& path, const std::string& key) {
    const auto archive = Archive::open(path);
    if (!archive) return archive.failure();
    const auto chosen = choose(*archive, key);
    if (!chosen) return chosen.failure();
    const auto member = archive->member(*chosen);
    if (!member) return member.failure();
    auto array = read_npy_from(**member);
    if (!array) return in_array(array.failure(), *chosen);
    return array;
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

namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::uint32_t kMaxHeaderBytes = 1U << 16U;  ///< a shape and a type need about a hundred
constexpr std::size_t kMaxRank = 32;                  ///< as in numpy 1
constexpr std::uint64_t kMaxBytes = std::numeric_limits<std::int64_t>::max();

Failure malformed_header(std::string message) {
    return {Code::malformed_array, std::move(message)};
}

/// Reads the dictionary literal. The first thing wrong stays in `failure`; every later step then
/// does nothing.
class Literal {
public:
    explicit Literal(std::string_view text) : text_(text) {}

    std::optional<Failure> read(NpyHeader& header) {
        expect('{');
        while (!failure_ && peek() != '}') {
            entry(header);
            if (peek() != '}') expect(',');
        }
        expect('}');
        if (!failure_ && peek() != '\0')
            fail(fmt::format("header goes on after its '}}': {}", in_quotes(text_.substr(at_))));
        for (const Key& key : keys_)
            if (!failure_ && !key.seen) fail(fmt::format("header has no key '{}'", key.name));
        return failure_;
    }

private:
    struct Key {
        std::string_view name;
        void (Literal::*value)(NpyHeader&);
        bool seen = false;
    };

    void entry(NpyHeader& header) {
        const std::string_view name = string();
        expect(':');
        if (failure_) return;
        for (Key& key : keys_) {
            if (key.name != name) continue;
            if (key.seen) return fail(fmt::format("header has the key '{}' twice", name));
            key.seen = true;
            return (this->*key.value)(header);
        }
        fail(fmt::format("header has the key {}, expected 'descr', 'fortran_order' and 'shape'",
                         in_quotes(name)));
    }

    void descr(NpyHeader& header) {
        if (peek() == '[') return fail_elements("structured elements (records)");
        const std::string_view text = string();
        if (failure_) return;
        const std::string_view code = text.substr(text.empty() ? 0 : 1);
        const auto element = element_of_code(code);
        const char order = text.empty() ? ' ' : text.front();
        if (element && order == '>' && info(*element).bytes > 1)
            return fail_elements(fmt::format("big-endian elements, '{}'", text));
        if (!element || (order != '<' && order != '|' && order != '>'))
            return fail_elements(
                fmt::format("elements of type {}{}", in_quotes(text), kind_of(code)));
        header.element = *element;
    }

    /// Describes a numpy type code that is not read: " (Python objects)".
    static std::string_view kind_of(std::string_view code) {
        switch (code.empty() ? ' ' : code.front()) {
            case 'O': return " (Python objects)";
            case 'c': return " (complex numbers)";
            case 'S':
            case 'U': return " (text)";
            case 'M':
            case 'm': return " (times)";
            case 'V': return " (raw bytes)";
            default: return "";
        }
    }

    void fortran_order(NpyHeader& header) {
        peek();
        const std::string_view rest = text_.substr(at_);
        header.fortran_order = rest.starts_with("True");
        if (!header.fortran_order && !rest.starts_with("False"))
            return fail(fmt::format("header's 'fortran_order' is {}, expected True or False",
                                    in_quotes(rest.substr(0, 10))));
        at_ += header.fortran_order ? 4 : 5;
    }

    void shape(NpyHeader& header) {
        expect('(');
        while (!failure_ && peek() != ')') {
            header.shape.push_back(dimension());
            if (header.shape.size() > kMaxRank)
                return fail(fmt::format("has more than {} dimensions", kMaxRank));
            // A tuple of one needs its comma: (3) is not a shape.
            if (peek() != ')' || header.shape.size() == 1) expect(',');
        }
        expect(')');
    }

    std::uint64_t dimension() {
        peek();
        std::uint64_t value = 0;
        const auto [end, error] =
            std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error == std::errc::result_out_of_range || value > kMaxBytes) {
            failure_ = Failure{Code::array_too_large, "has a dimension above 2^63 - 1"};
            return 0;
        }
        if (error != std::errc()) {
            fail(fmt::format("header's 'shape' holds {}, expected a dimension",
                             in_quotes(text_.substr(at_, 10))));
            return 0;
        }
        at_ = static_cast<std::size_t>(end - text_.data());
        if (at_ < text_.size() && text_[at_] == 'L') ++at_;  // Python 2 wrote 3L
        return value;
    }

    std::string_view string() {
        const char quote = peek();
        if (quote != '\'' && quote != '"') {
            fail(fmt::format("header has {}, expected a text in quotes", found()));
            return {};
        }
        const std::size_t end = text_.find(quote, at_ + 1);
        if (end == std::string_view::npos) {
            fail("header has a text without its closing quote");
            return {};
        }
        const std::string_view result = text_.substr(at_ + 1, end - at_ - 1);
        at_ = end + 1;
        return result;
    }

    void expect(char wanted) {
        const char c = peek();
        if (failure_) return;
        if (c != wanted) return fail(fmt::format("header has {}, expected '{}'", found(), wanted));
        ++at_;
    }

    /// Returns the next character that is not white space; NUL at the end.
    char peek() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' ||
                                      text_[at_] == '\t' || text_[at_] == '\r'))
            ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }

    std::string found() const {
        return at_ < text_.size() ? in_quotes(text_.substr(at_, 1)) : "its end";
    }

    void fail(std::string message) {
        if (!failure_) failure_ = malformed_header(std::move(message));
    }
    void fail_elements(const std::string& what) {
        if (!failure_)
            failure_ = Failure{
                Code::unsupported_elements,
                fmt::format(
                    "has {}, expected little-endian float16, float32, float64, integers or bool",
                    what)};
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::optional<Failure> failure_;
    std::array<Key, 3> keys_{{{"descr", &Literal::descr},
                              {"fortran_order", &Literal::fortran_order},
                              {"shape", &Literal::shape}}};
};

/// Returns the product of the shape; fails where the size in bytes overflows.
std::optional<Failure> count_elements(NpyHeader& header) {
    header.count = 1;
    for (const std::uint64_t n : header.shape)
        if (n == 0) header.count = 0;
    const std::uint64_t most = kMaxBytes / info(header.element).bytes;
    for (const std::uint64_t n : header.shape) {
        if (header.count == 0) break;
        if (n > most / header.count)
            return Failure{Code::array_too_large,
                           fmt::format("shape {} has more elements than can be counted",
                                       shape_text(header.shape))};
        header.count *= n;
    }
    return {};
}

/// Reads exactly `n` bytes; the Failure says that the file ends before `what` does.
diag::Result<std::string> read_exactly(ByteSource& source, std::size_t n, std::string_view what) {
    std::string bytes(n, '\0');
    const auto got = source.read(bytes.data(), n);
    if (!got) return got.failure();
    if (*got < n)
        return malformed_header(fmt::format("ends within the {}: {} bytes of {}", what, *got, n));
    return bytes;
}

}  // namespace

std::uint64_t NpyHeader::data_bytes() const {
    return count * info(element).bytes;
}

std::string shape_text(const std::vector<std::uint64_t>& shape) {
    return fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
}

diag::Result<NpyHeader> read_npy_header(ByteSource& source) {
    auto start = read_exactly(source, kMagic.size() + 2, "magic word");
    if (!start) return start.failure();
    if (!start->starts_with(kMagic))
        return malformed_header(fmt::format(
            "is no .npy array: begins with {}, expected {}",
            in_quotes(std::string_view(*start).substr(0, kMagic.size())), in_quotes(kMagic)));
    const int major = static_cast<unsigned char>((*start)[6]);
    const int minor = static_cast<unsigned char>((*start)[7]);
    if (major < 1 || major > 3 || minor != 0)
        return malformed_header(
            fmt::format("has .npy version {}.{}, expected 1.0, 2.0 or 3.0", major, minor));
    auto length_bytes = read_exactly(source, major == 1 ? 2 : 4, "length of the header");
    if (!length_bytes) return length_bytes.failure();
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < length_bytes->size(); ++i)
        length |= static_cast<std::uint32_t>(static_cast<unsigned char>((*length_bytes)[i]))
                  << (8 * i);
    if (length > kMaxHeaderBytes)
        return malformed_header(
            fmt::format("has a header of {} bytes, at most {} are read", length, kMaxHeaderBytes));
    auto text = read_exactly(source, length, "header");
    if (!text) return text.failure();
    NpyHeader header;
    if (auto failure = Literal(*text).read(header)) return *failure;
    if (auto failure = count_elements(header)) return *failure;
    header.header_bytes = start->size() + length_bytes->size() + length;
    return header;
}

std::optional<Failure> check_size(const NpyHeader& header, std::uint64_t total) {
    const std::uint64_t there = total < header.header_bytes ? 0 : total - header.header_bytes;
    if (there == header.data_bytes()) return {};
    return Failure{
        Code::wrong_array_size,
        fmt::format("{}: {} of shape {} takes {} bytes, {} are there",
                    there < header.data_bytes() ? "is cut short" : "has bytes left over",
                    name(header.element), shape_text(header.shape), header.data_bytes(), there)};
}

namespace {

constexpr std::array<ElementInfo, 12> kElements{{
    {Element::f16, "f2", "float16", 2},
    {Element::f32, "f4", "float32", 4},
    {Element::f64, "f8", "float64", 8},
    {Element::i8, "i1", "int8", 1},
    {Element::i16, "i2", "int16", 2},
    {Element::i32, "i4", "int32", 4},
    {Element::i64, "i8", "int64", 8},
    {Element::u8, "u1", "uint8", 1},
    {Element::u16, "u2", "uint16", 2},
    {Element::u32, "u4", "uint32", 4},
    {Element::u64, "u8", "uint64", 8},
    {Element::boolean, "b1", "bool", 1},
}};

/// Loads an unsigned integer from its little-endian bytes.
template <class Bits>
Bits load(const char* bytes) {
    Bits result = 0;
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(&result, bytes, sizeof result);
        return result;
    }
    for (std::size_t i = 0; i < sizeof(Bits); ++i)
        result = static_cast<Bits>(
            result | (static_cast<Bits>(static_cast<unsigned char>(bytes[i])) << (8 * i)));
    return result;
}

/// Converts each element by its bits. `__restrict` allows the compiler to vectorize: files have up
/// to a billion elements.
template <class Bits, class Convert>
std::size_t decode_each(const char* __restrict bytes, std::size_t n, double* __restrict to,
                        Convert convert) {
    for (std::size_t i = 0; i < n; ++i) to[i] = convert(load<Bits>(bytes + i * sizeof(Bits)));
    return n;
}

template <class Bits, class Number>
std::size_t decode_as(const char* bytes, std::size_t n, double* to) {
    return decode_each<Bits>(bytes, n, to,
                             [](Bits b) { return static_cast<double>(std::bit_cast<Number>(b)); });
}

std::size_t decode_booleans(const char* bytes, std::size_t n, double* to) {
    for (std::size_t i = 0; i < n; ++i) {
        if (bytes[i] != 0 && bytes[i] != 1) return i;
        to[i] = bytes[i];
    }
    return n;
}

}  // namespace

const ElementInfo& info(Element element) {
    return *std::find_if(kElements.begin(), kElements.end(),
                         [&](const auto& row) { return row.element == element; });
}

std::string_view name(Element element) {
    return info(element).name;
}

std::optional<Element> element_of_code(std::string_view code) {
    for (const ElementInfo& row : kElements)
        if (row.code == code) return row.element;
    return {};
}

double half_to_double(std::uint16_t bits) {
    const int exponent = (bits >> 10) & 0x1f;
    const int mantissa = bits & 0x3ff;
    double magnitude = 0;
    if (exponent == 0)
        magnitude = std::ldexp(mantissa, -24);
    else if (exponent < 0x1f)
        magnitude = std::ldexp(0x400 + mantissa, exponent - 25);
    else
        magnitude = mantissa == 0 ? std::numeric_limits<double>::infinity()
                                  : std::numeric_limits<double>::quiet_NaN();
    return (bits & 0x8000) != 0 ? -magnitude : magnitude;
}

std::size_t decode(Element element, const char* bytes, std::size_t n, double* to) {
    switch (element) {
        case Element::f16: return decode_each<std::uint16_t>(bytes, n, to, half_to_double);
        case Element::f32: return decode_as<std::uint32_t, float>(bytes, n, to);
        case Element::f64: return decode_as<std::uint64_t, double>(bytes, n, to);
        case Element::i8: return decode_as<std::uint8_t, std::int8_t>(bytes, n, to);
        case Element::i16: return decode_as<std::uint16_t, std::int16_t>(bytes, n, to);
        case Element::i32: return decode_as<std::uint32_t, std::int32_t>(bytes, n, to);
        case Element::i64: return decode_as<std::uint64_t, std::int64_t>(bytes, n, to);
        case Element::u8: return decode_as<std::uint8_t, std::uint8_t>(bytes, n, to);
        case Element::u16: return decode_as<std::uint16_t, std::uint16_t>(bytes, n, to);
        case Element::u32: return decode_as<std::uint32_t, std::uint32_t>(bytes, n, to);
        case Element::u64: return decode_as<std::uint64_t, std::uint64_t>(bytes, n, to);
        case Element::boolean: return decode_booleans(bytes, n, to);
    }
    return 0;
}

}  // namespace etlc::data
