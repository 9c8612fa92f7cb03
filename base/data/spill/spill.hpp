// Temporary files, for what grows with the number of frames or episodes: bytes, values in their
// order, and sorted values.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <queue>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "data/files/file.hpp"

namespace etlc::data {

// Values as bytes, and back.
// Takes: values whose type has a function `fields(archive, value)`, which names every member in
// order, for both directions. Gives: their bytes, the same on every machine; or the values. Keeps
// true: what was written reads back equal, bit for bit; bytes that no value is written as are
// noticed, and take no more memory than they have.

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

// Bytes that need not stay in memory.
// Takes: bytes, appended. Gives: those from any place on. Keeps true: no more than kInMemory of
// them are in memory; the rest lies in a file without a name, in the folder for temporary files
// (TMPDIR), which is gone with the process. Few bytes never reach a disk.

/// A temporary file that cannot be made, written or read; the message says where and why.
class SpillError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

class SpillFile {
public:
    static constexpr std::size_t kInMemory = std::size_t{1} << 20U;

    /// Gives the place of the first of them. May throw SpillError, as the others.
    std::uint64_t append(std::string_view bytes);
    /// `n` bytes from `at` on, which are there.
    void read(std::uint64_t at, char* to, std::size_t n) const;
    std::uint64_t size() const { return stored_ + last_.size(); }

private:
    void store();

    Descriptor file_;
    std::uint64_t stored_ = 0;  ///< bytes in the file
    std::string last_;          ///< those behind them
};

// Values in ascending order, of which any number takes little memory.
// Takes: values of a fixed size, in any order. Gives: them in order, in as many passes as are asked
// for. Keeps true: memory is that of kInMemory bytes, however many there are: beyond it, sorted
// runs of them are kept in a file and merged (external merge sort).

/// `T`: compared by <, whole: values of which neither is less are equal. First all are added, then
/// they are visited.
template <class T>
class Sorted {
public:
    static_assert(std::is_trivially_copyable_v<T>);
    static constexpr std::size_t kInMemory = std::size_t{1} << 21U;  ///< bytes

    void add(const T& value) {
        if (last_.size() == kRun) store_run();
        last_.push_back(value);
        is_sorted_ = false;
    }

    std::uint64_t size() const { return last_.size() + stored_.size() / sizeof(T); }

    /// Calls `visit(value)` for each, in order.
    template <class Visit>
    void for_each(const Visit& visit) const {
        sort();
        if (runs_.empty()) {
            for (const T& value : last_) visit(value);
            return;
        }
        Window all(stored_, 0, stored_.size() / sizeof(T), kBlock);
        for (; !all.is_done(); all.next()) visit(all.value());
    }

private:
    static constexpr std::size_t kRun = kInMemory / sizeof(T);
    static constexpr std::size_t kBlock = 4096;  ///< values that are read at a time

    /// A part of the stored values, a block of them after the other.
    class Window {
    public:
        Window(const SpillFile& file, std::uint64_t begin, std::uint64_t end, std::size_t block)
            : file_(&file), next_(begin), end_(end), most_(block) {
            fill();
        }
        bool is_done() const { return at_ == block_.size(); }
        const T& value() const { return block_[at_]; }
        void next() {
            if (++at_ == block_.size()) fill();
        }

    private:
        void fill() {
            block_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(most_, end_ - next_)));
            file_->read(next_ * sizeof(T), reinterpret_cast<char*>(block_.data()),
                        block_.size() * sizeof(T));
            next_ += block_.size();
            at_ = 0;
        }

        const SpillFile* file_;
        std::uint64_t next_;
        std::uint64_t end_;
        std::size_t most_;
        std::vector<T> block_;
        std::size_t at_ = 0;
    };

    void store(const std::vector<T>& values) const {
        stored_.append({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
    }

    void store_run() const {
        std::sort(last_.begin(), last_.end());
        runs_.push_back(stored_.size() / sizeof(T));
        store(last_);
        last_.clear();
    }

    /// Once all are there.
    void sort() const {
        if (is_sorted_) return;
        is_sorted_ = true;
        if (runs_.empty()) return std::sort(last_.begin(), last_.end());
        if (!last_.empty()) store_run();
        last_ = {};
        merge();
    }

    /// All runs become one.
    void merge() const {
        const SpillFile runs = std::exchange(stored_, {});
        std::vector<Window> windows;
        const std::size_t block = std::max<std::size_t>(16, kRun / runs_.size());
        for (std::size_t i = 0; i < runs_.size(); ++i) {
            const bool is_last = i + 1 == runs_.size();
            windows.emplace_back(runs, runs_[i], is_last ? runs.size() / sizeof(T) : runs_[i + 1],
                                 block);
        }
        const auto later = [&](std::size_t a, std::size_t b) {
            return windows[b].value() < windows[a].value();
        };
        std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> least(later);
        for (std::size_t i = 0; i < windows.size(); ++i) least.push(i);
        std::vector<T> merged;
        while (!least.empty()) {
            const std::size_t i = least.top();
            least.pop();
            merged.push_back(windows[i].value());
            windows[i].next();
            if (!windows[i].is_done()) least.push(i);
            if (merged.size() == kBlock || least.empty()) {
                store(merged);
                merged.clear();
            }
        }
        runs_ = {0};
    }

    // Put in order by the first who asks for it.
    mutable std::vector<T> last_;              ///< those of no run
    mutable std::vector<std::uint64_t> runs_;  ///< where each begins, in values
    mutable SpillFile stored_;
    mutable bool is_sorted_ = true;
};

// Values in the order in which they came, of which any number takes little memory.
// Takes: values that pack.hpp can pack, one after the other. Gives: them back, all in order or any
// one. Keeps true: memory is that of one value, of 8 bytes for each, and of a SpillFile.

template <class T>
class Spool {
public:
    void add(const T& value) {
        Writer writer;
        writer(value);
        begins_.push_back(bytes_.append(writer.bytes()));
    }

    std::size_t size() const { return begins_.size(); }
    bool empty() const { return begins_.empty(); }

    T operator[](std::size_t i) const {
        const std::uint64_t end = i + 1 < begins_.size() ? begins_[i + 1] : bytes_.size();
        std::string packed(static_cast<std::size_t>(end - begins_[i]), '\0');
        bytes_.read(begins_[i], packed.data(), packed.size());
        auto value = unpacked<T>(packed);
        if (!value) throw SpillError("a temporary file was changed by another program");
        return std::move(*value);
    }

    /// Calls `visit(i, value)` for each.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (std::size_t i = 0; i < size(); ++i) visit(i, (*this)[i]);
    }

private:
    std::vector<std::uint64_t> begins_;
    SpillFile bytes_;
};

}  // namespace etlc::data
