// Writes plain numbers as bytes of this machine, and reads them back. What is written is read by
// the same visit(), so both agree.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace etlc::execute {

class Writer {
public:
    explicit Writer(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

    template <class Number>
    void number(const Number& x) {
        static_assert(std::is_trivially_copyable_v<Number>);
        add(&x, sizeof x);
    }
    /// Writes a vector whose size the plan gives.
    template <class Number>
    void fixed(const std::vector<Number>& numbers) {
        static_assert(std::is_trivially_copyable_v<Number>);
        number(std::uint64_t{numbers.size()});
        add(numbers.data(), numbers.size() * sizeof(Number));
    }
    /// Writes a vector of any size.
    template <class Number>
    void some(const std::vector<Number>& numbers) {
        fixed(numbers);
    }
    void bools(const std::vector<bool>& flags) {
        for (const bool flag : flags) number(std::uint8_t{flag});
    }
    void flag(bool x) { number(std::uint8_t{x}); }

private:
    void add(const void* from, std::size_t size) {
        const auto* const first = static_cast<const std::uint8_t*>(from);
        bytes_.insert(bytes_.end(), first, first + size);
    }

    std::vector<std::uint8_t>& bytes_;
};

/// Reads no further than the bytes go: the first number that is not there, or not as expected,
/// makes it bad, and what follows is left as it is.
class Reader {
public:
    explicit Reader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

    bool good() const { return good_; }
    std::span<const std::uint8_t> rest() const { return rest_; }

    template <class Number>
    void number(Number& x) {
        static_assert(std::is_trivially_copyable_v<Number>);
        take(&x, sizeof x);
    }
    template <class Number>
    void fixed(std::vector<Number>& numbers) {
        if (size() != numbers.size()) good_ = false;
        take(numbers.data(), numbers.size() * sizeof(Number));
    }
    template <class Number>
    void some(std::vector<Number>& numbers) {
        const std::uint64_t count = size();
        if (count > rest_.size() / sizeof(Number)) good_ = false;
        if (!good_) return;
        numbers.resize(count);
        take(numbers.data(), count * sizeof(Number));
    }
    void bools(std::vector<bool>& flags) {
        for (std::size_t i = 0; i < flags.size(); ++i) flags[i] = next_flag();
    }
    void flag(bool& x) { x = next_flag(); }

private:
    std::uint64_t size() {
        std::uint64_t count = 0;
        number(count);
        return count;
    }
    bool next_flag() {
        std::uint8_t flag = 0;
        number(flag);
        if (flag > 1) good_ = false;
        return flag == 1;
    }
    void take(void* to, std::size_t size) {
        if (rest_.size() < size) good_ = false;
        if (!good_ || size == 0) return;
        std::memcpy(to, rest_.data(), size);
        rest_ = rest_.subspan(size);
    }

    std::span<const std::uint8_t> rest_;
    bool good_ = true;
};

}  // namespace etlc::execute
