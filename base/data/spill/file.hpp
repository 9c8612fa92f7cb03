// Bytes that need not stay in memory.
// Takes: bytes, appended. Gives: those from any place on. Keeps true: no more than kInMemory of
// them are in memory; the rest lies in a file without a name, in the folder for temporary files
// (TMPDIR), which is gone with the process. Few bytes never reach a disk.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "data/files/descriptor.hpp"

namespace etlc::data {

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

}  // namespace etlc::data
