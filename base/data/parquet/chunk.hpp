// The cells of a column in a row group.
// Takes: the file's bytes, the column and where its values lie. Gives: a cell a row. Keeps true: a
// page is unpacked at a time, beside the dictionary; numbers are what the file says, integers above
// 2^53 the nearest double.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/parquet/footer.hpp"
#include "data/parquet/runs.hpp"

namespace etlc::data::parquet {

/// One row of a column: a value, or a list of them.
struct Cell {
    bool is_null = false;            ///< the value, or the list as a whole
    std::vector<double> numbers;     ///< NaN for a null in a list
    std::vector<std::string> texts;  ///< of a column of text; empty for a null in a list
    std::size_t count(const Column& column) const {
        return column.is_text() ? texts.size() : numbers.size();
    }
};

inline constexpr std::size_t kMaxElements = 1U << 20U;    ///< of a cell
inline constexpr std::size_t kMaxTextBytes = 16'000'000;  ///< or an image; fits into a record

class ChunkReader {
public:
    /// Of a column that is read. Throws Refused, here and below; the words do not name the column.
    ChunkReader(std::string_view file, const Column& column, const Chunk& chunk);

    /// The next row; false behind the last.
    bool next(Cell& cell);
    /// Goes on behind so many rows, which have to be there; whole pages of them at a time.
    void skip(std::uint64_t rows);

private:
    enum class Values : std::uint8_t { plain, places, runs_of_bools };

    struct PageHead;
    PageHead read_head();
    bool load_page();
    void load_dictionary(const PageHead& head, std::string_view packed);
    void load_data(const PageHead& head, std::string_view packed);
    void begin_values(std::int64_t encoding, std::string_view bytes);

    /// Makes an entry of the levels current; false at the end.
    bool fetch();
    bool read(Cell* cell);
    /// Whether what comes is the begin of a row; the rows that begin in the rest of the page.
    bool is_at_row() const;
    std::uint64_t rows_left() const;
    /// The end of a row that began in a page before.
    void end_row();
    void add_value(Cell* cell);
    void plain(Cursor& from, double& number, std::string& text);
    double plain_number(Cursor& from) const;

    const Column& column_;
    std::int64_t codec_;
    std::string_view bytes_;     ///< of the chunk, from the next page on
    std::uint64_t left_;         ///< entries of the chunk that no page has given yet
    std::string page_;           ///< unpacked
    std::uint64_t in_page_ = 0;  ///< entries of the page to come
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

}  // namespace etlc::data::parquet
