// Text that is read a piece at a time, and the places in it.
// Takes: where its bytes come from. Gives: one byte after the other; of the last ones line, column
// and character. Keeps true: memory is that of a piece; what cannot be read, and what counts beyond
// a limit, is as if the text ended there, and stays in `failure`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "data/files/bytes.hpp"
#include "diag/diag.hpp"
#include "source/source.hpp"

namespace etlc::thresholds {

class Text {
public:
    /// At most `most` bytes count. `unreadable`: the code where there are more, or where a file
    /// cannot be read.
    Text(data::ByteSource& source, std::uint64_t most, diag::Code unreadable)
        : source_(source), most_(most), unreadable_(unreadable) {}

    bool at_end() { return at_ == piece_.size() && !next_piece(); }
    /// The byte that comes next, where it is not the end.
    char peek() const { return piece_[at_]; }
    void advance() { ++at_; }

    /// Whether what was read since the last call counts: what takes no memory any more does not.
    void pass(bool counts) {
        if (counts) counted_ += read() - passed_;
        passed_ = read();
    }

    /// Of byte number `at`, one of the last two that were read or the end. Columns are characters.
    source::Position place(std::uint64_t at) const;
    /// The UTF-8 character that begins there; nothing at the end.
    std::string character(std::uint64_t at);

    const std::optional<diag::Failure>& failure() const { return failure_; }

    /// Reads on to the end; how many bytes there were.
    std::uint64_t finish() {
        for (at_ = piece_.size(); !at_end(); at_ = piece_.size()) pass(false);
        return read();
    }

private:
    std::uint64_t read() const { return begin_ + at_; }
    bool next_piece();
    bool extend();

    data::ByteSource& source_;
    std::uint64_t most_;
    diag::Code unreadable_;
    std::string piece_;
    std::size_t at_ = 0;       ///< in the piece
    std::uint64_t begin_ = 0;  ///< of the piece in the text
    source::Position begin_place_{1, 1};
    std::uint64_t counted_ = 0;
    std::uint64_t passed_ = 0;  ///< up to where it is known what counts
    std::optional<diag::Failure> failure_;
};

}  // namespace etlc::thresholds
