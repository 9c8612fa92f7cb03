#include "data/arrays/npy_header.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <limits>

#include "data/arrays/elements.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

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

}  // namespace etlc::data
