// Values as bytes, and back.
// Takes: values whose type has a function `fields(archive, value)`, which names every member in
// order, for both directions. Gives: their bytes, the same on every machine; or the values. Keeps
// true: what was written reads back equal, bit for bit; bytes that no value is written as are
// noticed, and take no more memory than they have.
#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace etlc::data {

template <class T>
inline constexpr bool is_number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// The bits of a number, which all are written as 8 bytes.
template <class T>
std::uint64_t bits_of(T value) {
    if constexpr (std::is_same_v<T, double>)
        return std::bit_cast<std::uint64_t>(value);
    else if constexpr (std::is_same_v<T, float>)
        return std::bit_cast<std::uint32_t>(value);
    else
        return static_cast<std::uint64_t>(value);
}

template <class T>
T from_bits(std::uint64_t bits) {
    if constexpr (std::is_same_v<T, double>)
        return std::bit_cast<double>(bits);
    else if constexpr (std::is_same_v<T, float>)
        return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    else
        return static_cast<T>(bits);
}

class Writer {
public:
    template <class... T>
    void operator()(const T&... values) {
        (add(values), ...);
    }
    const std::string& bytes() const { return bytes_; }

private:
    template <class T>
    void add(const T& value) {
        if constexpr (is_number<T>) {
            const std::uint64_t bits = bits_of(value);
            char bytes[8];
            for (unsigned i = 0; i < sizeof bytes; ++i)
                bytes[i] = static_cast<char>(bits >> (8 * i) & 0xFFU);
            bytes_.append(bytes, sizeof bytes);
        } else {
            fields(*this, const_cast<T&>(value));  // which only reads it here
        }
    }
    void add(const std::string& text) {
        add(text.size());
        bytes_ += text;
    }
    template <class T>
    void add(const std::vector<T>& values) {
        add(values.size());
        for (const T& value : values) add(value);
    }
    template <class T>
    void add(const std::optional<T>& value) {
        add(value.has_value());
        if (value) add(*value);
    }
    template <class Key, class Value>
    void add(const std::map<Key, Value>& values) {
        add(values.size());
        for (const auto& [key, value] : values) (*this)(key, value);
    }

    std::string bytes_;
};

class Reader {
public:
    explicit Reader(std::string_view bytes) : rest_(bytes) {}

    template <class... T>
    void operator()(T&... values) {
        (get(values), ...);
    }
    /// Whether all bytes have been read, none was missing, and a Writer could have written them.
    bool is_done() const { return good_ && rest_.empty(); }

private:
    static constexpr std::size_t kNumber = 8;  ///< bytes

    template <class T>
    void get(T& value) {
        if constexpr (is_number<T>) {
            const std::uint64_t bits = number();
            value = from_bits<T>(bits);
            good_ = good_ && bits_of(value) == bits;  // a bool of 2 is none
        } else {
            fields(*this, value);
        }
    }
    void get(std::string& text) {
        const std::size_t size = count();
        text = rest_.substr(0, size);
        rest_.remove_prefix(size);
    }
    template <class T>
    void get(std::vector<T>& values) {
        const std::size_t size = count();
        values.clear();
        for (std::size_t i = 0; i < size && good_; ++i) get(values.emplace_back());
    }
    template <class T>
    void get(std::optional<T>& value) {
        bool has_value = false;
        get(has_value);
        if (has_value) get(value.emplace());
    }
    template <class Key, class Value>
    void get(std::map<Key, Value>& values) {
        for (std::size_t n = count(); n > 0 && good_; --n) {
            Key key{};
            get(key);
            good_ = good_ && (values.empty() || values.rbegin()->first < key);  // as it is written
            get(values[key]);
        }
    }

    std::uint64_t number() {
        if (rest_.size() < kNumber) {
            good_ = false;
            rest_ = {};
            return 0;
        }
        std::uint64_t bits = 0;
        for (unsigned i = 0; i < kNumber; ++i)
            bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(rest_[i])) << (8 * i);
        rest_.remove_prefix(kNumber);
        return bits;
    }

    /// Reads the number of items that follow, of at least a byte each.
    std::size_t count() {
        const std::uint64_t n = number();
        if (n <= rest_.size()) return n;
        good_ = false;
        rest_ = {};
        return 0;
    }

    std::string_view rest_;
    bool good_ = true;
};

template <class T>
std::string packed(const T& value) {
    Writer writer;
    writer(value);
    return writer.bytes();
}

/// Nothing where the bytes are no such value.
template <class T>
std::optional<T> unpacked(std::string_view bytes) {
    std::optional<T> value(std::in_place);
    Reader reader(bytes);
    reader(*value);
    if (!reader.is_done()) value.reset();
    return value;
}

}  // namespace etlc::data
