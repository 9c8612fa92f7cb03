// Temporary files, for what grows with the number of frames or episodes: bytes, values in their
// order, and sorted values.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <queue>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "data/files/file.hpp"
#include "data/spill/pack.hpp"

namespace etlc::data {

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
