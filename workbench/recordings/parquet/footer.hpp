// The footer of a Parquet file: its columns and the places of their values.
// Takes: the bytes of the file. Gives: the columns, with a reason for each that cannot be read.
// Keeps true: every place lies within the file; nothing is decompressed. Source:
// apache/parquet-format, parquet.thrift and LogicalTypes.md, 2.10.
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/records/protocol.hpp"

namespace etlc::recordings::parquet {

enum class Physical : std::uint8_t {
    boolean = 0,
    int32 = 1,
    int64 = 2,
    int96 = 3,
    float32 = 4,
    float64 = 5,
    binary = 6,
    fixed = 7
};

enum Repetition : std::int64_t { kRequired = 0, kOptional = 1, kRepeated = 2 };

inline constexpr std::string_view kMagic = "PAR1";

/// A field of the table, or one of a struct in it: a value a row, or a list of values a row.
struct Column {
    std::string name;  ///< of a field of a struct "STRUCT.FIELD"; each part may have dots itself
    Physical physical = Physical::float32;
    bool is_unsigned = false;
    bool is_list = false;
    std::uint8_t most_defined = 0;     ///< the level of a value that is there; below it is null
    std::uint8_t element_level = 0;    ///< from this level on there is an element, of a list
    std::uint8_t null_list_level = 0;  ///< below this level the list itself is null
    std::string why_not;               ///< it is not read; empty: it is
    std::size_t leaf = 0;              ///< its place among the chunks of a row group

    bool is_text() const { return physical == Physical::binary; }
};

/// The values of a column in a row group.
struct Chunk {
    std::int64_t codec = 0;
    std::uint64_t values = 0;
    std::uint64_t begin = 0;  ///< in the file
    std::uint64_t bytes = 0;
    std::string why_not;  ///< it is not read; empty: it is
};

struct RowGroup {
    std::uint64_t rows = 0;
    std::vector<Chunk> chunks;  ///< by leaf
};

struct Footer {
    std::vector<Column> columns;
    std::vector<RowGroup> groups;
    std::uint64_t rows = 0;
};

/// Throws Refused.
Footer read_footer(std::string_view file);
/// Reads the bytes of a footer alone, which begins at `begin` in its file.
Footer parse_footer(std::string_view bytes, std::uint64_t begin);

inline constexpr std::uint64_t kMaxRows = 1ULL << 26U;
inline constexpr std::size_t kMaxFooterBytes = 64U << 20U;

// Reads the bytes of a Parquet file from the front: little-endian numbers and parts.
// Keeps true: missing bytes are refused, with the name of what was expected.

/// Why a Parquet file is not read. etlc-read-parquet sends the text to etlc.
class Refused : public std::runtime_error {
public:
    Refused(records::Cause cause, const std::string& why)
        : std::runtime_error(why), cause_(cause) {}
    records::Cause cause() const { return cause_; }

private:
    records::Cause cause_;
};

/// Refuses a file that contradicts itself.
[[noreturn]] inline void refuse(const std::string& why) {
    throw Refused(records::Cause::file, why);
}

class Cursor {
public:
    explicit Cursor(std::string_view bytes = {}) : bytes_(bytes) {}

    std::string_view rest() const { return bytes_; }
    bool at_end() const { return bytes_.empty(); }

    std::string_view take(std::uint64_t n, const char* what) {
        if (n > bytes_.size())
            refuse(std::string("ends in ") + what + ": " + std::to_string(n) + " bytes expected, " +
                   std::to_string(bytes_.size()) + " are there");
        const std::string_view part = bytes_.substr(0, n);
        bytes_.remove_prefix(n);
        return part;
    }

    std::uint8_t byte(const char* what) { return static_cast<std::uint8_t>(take(1, what)[0]); }

    /// The byte order of the file is that of the machine.
    template <class T>
    T number(const char* what) {
        T value;
        std::memcpy(&value, take(sizeof value, what).data(), sizeof value);
        return value;
    }

    /// Reads seven bits a byte, the lowest first.
    std::uint64_t varint(const char* what) {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            const std::uint8_t part = byte(what);
            value |= std::uint64_t{part & 0x7fU} << shift;
            if (part < 0x80) return value;
        }
        refuse(std::string("has a number of more than 64 bits in ") + what);
    }

private:
    std::string_view bytes_;
};

// The compact protocol of Apache Thrift, in which Parquet writes its footer and its page headers.
// Takes: bytes. Gives: the fields of a struct, each to a function that reads it or leaves it.
// Keeps true: nesting and the lengths of lists are bounded by the bytes that are there. Source:
// thrift/doc/specs/thrift-compact-protocol.md.

enum class Type : std::uint8_t {
    stop = 0,
    yes = 1,
    no = 2,
    i8 = 3,
    i16 = 4,
    i32 = 5,
    i64 = 6,
    real = 7,
    binary = 8,
    list = 9,
    set = 10,
    map = 11,
    structure = 12
};

class Thrift {
public:
    explicit Thrift(std::string_view bytes) : bytes_(bytes) {}

    /// Returns the bytes that were not read.
    std::string_view rest() const { return bytes_.rest(); }

    /// Calls `field(id, type)` for every field; one that gives false is passed over.
    template <class Field>
    void structure(Field field) {
        const Nested nested(depth_);
        std::int64_t id = 0;
        for (;;) {
            const std::uint8_t head = bytes_.byte(kWhat);
            const auto type = static_cast<Type>(head & 0x0fU);
            if (type == Type::stop) return;
            id = (head >> 4U) != 0 ? id + (head >> 4U) : whole();
            if (id < 0 || id > kMostFields) wrong();
            if (!field(id, type)) pass_over(type);
        }
    }

    /// Calls `element(type)` for every element, which reads it.
    template <class Element>
    void list(Type type, Element element) {
        if (type != Type::list && type != Type::set) wrong();
        const Nested nested(depth_);
        const std::uint8_t head = bytes_.byte(kWhat);
        const std::uint64_t count = (head >> 4U) == 15 ? bytes_.varint(kWhat) : head >> 4U;
        if (count > bytes_.rest().size())  // an element takes at least a byte
            refuse("lists " + std::to_string(count) + " things in " +
                   std::to_string(bytes_.rest().size()) + " bytes of " + kWhat);
        for (std::uint64_t i = 0; i < count; ++i) element(static_cast<Type>(head & 0x0fU));
    }

    std::int64_t whole(Type type) {
        if (type == Type::i8) return static_cast<std::int8_t>(bytes_.byte(kWhat));
        if (type != Type::i16 && type != Type::i32 && type != Type::i64) wrong();
        return whole();
    }
    std::string_view binary(Type type) {
        if (type != Type::binary) wrong();
        return bytes_.take(bytes_.varint(kWhat), kWhat);
    }
    bool truth(Type type) const {
        if (type != Type::yes && type != Type::no) wrong();
        return type == Type::yes;
    }

    void pass_over(Type type);
    void pass_over_element(Type type);

private:
    static constexpr const char* kWhat = "its metadata";
    static constexpr int kMostNested = 32;
    static constexpr std::int64_t kMostFields = 0x7fff;

    class Nested {
    public:
        explicit Nested(int& depth) : depth_(depth) {
            if (++depth_ > kMostNested) refuse("nests its metadata too deep");
        }
        Nested(const Nested&) = delete;
        Nested& operator=(const Nested&) = delete;
        ~Nested() { --depth_; }

    private:
        int& depth_;
    };

    [[noreturn]] static void wrong() { refuse("has a field of another type in its metadata"); }

    std::int64_t whole() {
        const std::uint64_t zigzag = bytes_.varint(kWhat);
        return static_cast<std::int64_t>(zigzag >> 1U) ^ -static_cast<std::int64_t>(zigzag & 1U);
    }

    Cursor bytes_;
    int depth_ = 0;
};

}  // namespace etlc::recordings::parquet
