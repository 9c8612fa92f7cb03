// The compact protocol of Apache Thrift, in which Parquet writes its footer and its page headers.
// Takes: bytes. Gives: the fields of a struct, each to a function that reads it or leaves it.
// Keeps true: nesting and the lengths of lists are bounded by the bytes that are there. Source:
// thrift/doc/specs/thrift-compact-protocol.md.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "data/parquet/cursor.hpp"

namespace etlc::data::parquet {

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
    void pass_over_element(Type type);

    Cursor bytes_;
    int depth_ = 0;
};

}  // namespace etlc::data::parquet
