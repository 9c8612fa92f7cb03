// The cells of a column in a row group.
// Takes: the file's bytes, the column and the place of its values. Gives: a cell a row. Keeps true:
// only one page and the dictionary are in memory; integers above 2^53 become the nearest double.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/parquet/footer.hpp"

namespace etlc::recordings::parquet {

/// The hybrid of runs and packed bits in which Parquet writes levels and dictionary places. Memory
/// does not grow with the length of a run. Source: apache/parquet-format, Encodings.md, "Run Length
/// Encoding / Bit-Packing Hybrid".
class Runs {
public:
    Runs() = default;
    Runs(std::string_view bytes, unsigned bits, const char* what)
        : bytes_(bytes), bits_(bits), what_(what) {}

    std::uint32_t next() {
        while (left_ == 0) begin();
        --left_;
        return packed_.empty() ? value_ : unpack();
    }

    /// Counts the zeros among the next `n` numbers of one bit.
    std::uint64_t zeros(std::uint64_t n) {
        std::uint64_t found = 0;
        while (n > 0) {
            while (left_ == 0) begin();
            std::uint64_t part = std::min(n, left_);
            if (packed_.empty()) {
                found += value_ == 0 ? part : 0;
            } else if (part < 8 || bit_ % 8 != 0) {
                found += unpack() == 0 ? 1 : 0;
                part = 1;
            } else {
                part -= part % 8;
                for (const char byte : packed_.substr(bit_ / 8, part / 8))
                    found +=
                        8U - static_cast<unsigned>(std::popcount(static_cast<unsigned char>(byte)));
                bit_ += part;
            }
            left_ -= part;
            n -= part;
        }
        return found;
    }

private:
    void begin() {
        const std::uint64_t head = bytes_.varint(what_);
        if ((head & 1U) == 0) {
            left_ = head >> 1U;
            packed_ = {};
            value_ = 0;
            for (unsigned shift = 0; shift < bits_; shift += 8)
                value_ |= std::uint32_t{bytes_.byte(what_)} << shift;
            return;
        }
        // Eight numbers a group; some writers leave out the end of the last group.
        const std::uint64_t groups = head >> 1U;
        value_ = 0;
        if (bits_ == 0) {
            packed_ = {};
            left_ = 8 * groups;
            return;
        }
        const std::uint64_t most = 8 * bytes_.rest().size() / bits_;
        if (groups > 0 && most == 0) bytes_.take(bits_, what_);  // says that it ends
        left_ = groups <= most / 8 ? 8 * groups : most;
        packed_ = bytes_.take((left_ * bits_ + 7) / 8, what_);
        bit_ = 0;
    }

    std::uint32_t unpack() {
        std::uint64_t word = 0;
        const std::uint64_t first = bit_ / 8;
        for (std::uint64_t i = 0; i < 5 && first + i < packed_.size(); ++i)
            word |= std::uint64_t{static_cast<std::uint8_t>(packed_[first + i])} << (8 * i);
        const std::uint64_t value = (word >> (bit_ % 8)) & ((1ULL << bits_) - 1);
        bit_ += bits_;
        return static_cast<std::uint32_t>(value);
    }

    Cursor bytes_;
    unsigned bits_ = 0;
    const char* what_ = "";
    std::uint64_t left_ = 0;
    std::uint32_t value_ = 0;
    std::string_view packed_;
    std::uint64_t bit_ = 0;
};

/// One row of a column: a value or a list.
struct Cell {
    bool is_null = false;            ///< the value, or the list as a whole
    std::vector<double> numbers;     ///< NaN for a null in a list
    std::vector<std::string> texts;  ///< values of a text column; empty for a null in a list
    std::size_t count(const Column& column) const {
        return column.is_text() ? texts.size() : numbers.size();
    }
};

inline constexpr std::size_t kMaxElements = 1U << 20U;  ///< of a cell
inline constexpr std::size_t kMaxTextBytes =
    16'000'000;  ///< of a text or an image; fits into a record

class ChunkReader {
public:
    /// Takes a column that can be read. Throws Refused, as the other functions do; the text does
    /// not name the column.
    ChunkReader(std::string_view file, const Column& column, const Chunk& chunk);

    /// Reads the next row; false at the end.
    bool next(Cell& cell);
    /// Skips so many rows, which must exist, by whole pages where possible.
    void skip(std::uint64_t rows);

private:
    enum class Values : std::uint8_t { plain, places, runs_of_bools };

    struct PageHead;
    PageHead read_head();
    bool load_page();
    void load_dictionary(const PageHead& head, std::string_view packed);
    void load_data(const PageHead& head, std::string_view packed);
    void begin_values(std::int64_t encoding, std::string_view bytes);

    /// Advances to the next entry of the levels; false at the end.
    bool fetch();
    bool read(Cell* cell);
    /// Returns whether the next entry begins a row; the number of rows that begin in the rest of
    /// the page.
    bool is_at_row() const;
    std::uint64_t rows_left() const;
    /// Finishes a row that began in an earlier page.
    void end_row();
    void add_value(Cell* cell);
    void plain(Cursor& from, double& number, std::string& text);
    double plain_number(Cursor& from) const;

    const Column& column_;
    std::int64_t codec_;
    std::string_view bytes_;     ///< the chunk from the next page on
    std::uint64_t left_;         ///< entries of the chunk that are not in a page yet
    std::string page_;           ///< unpacked
    std::uint64_t in_page_ = 0;  ///< remaining entries of the page
    Runs repetitions_;
    Runs definitions_;
    Values values_ = Values::plain;
    Cursor plain_;
    std::uint8_t bool_bits_ = 0;
    unsigned bools_left_ = 0;
    std::optional<Runs> places_;
    std::string_view place_bytes_;
    bool has_dictionary_ = false;
    std::vector<double> number_dictionary_;
    std::vector<std::string> text_dictionary_;
    bool has_entry_ = false;
    std::uint32_t repetition_ = 0;
    std::uint32_t definition_ = 0;
};

}  // namespace etlc::recordings::parquet
