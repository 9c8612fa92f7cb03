// The rows of a Parquet file.
// Takes: the bytes of the file and the names of columns. Gives: their cells, a row at a time. Keeps
// true: columns that are not asked for are not read, whatever is in them; every column of a row
// group has as many rows as the group; memory is that of a page of each column and its dictionary.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/parquet/chunk.hpp"
#include "recordings/parquet/footer.hpp"

namespace etlc::recordings::parquet {

class Rows {
public:
    /// Throws Refused, here and below; the words name the column.
    Rows(std::string_view file, const std::vector<std::string>& names);

    /// Only rows whose cell of this column is this number.
    void keep(const std::string& key, double value);

    /// By name; null: the file has no such column.
    const std::vector<const Column*>& columns() const { return columns_; }
    std::uint64_t rows() const { return footer_.rows; }

    /// The cells of the columns that are there; false behind the last row.
    bool next(std::vector<Cell>& cells);

private:
    const Column* find(const std::string& name) const;
    /// The rows of a group from the first that is kept to the last.
    struct Span {
        std::uint64_t begin = 0;
        std::uint64_t end = 0;
    };
    Span kept_in(const RowGroup& group) const;
    bool begin_group();
    void end_group();
    bool is_kept();

    std::string_view file_;
    Footer footer_;
    std::vector<const Column*> columns_;
    const Column* key_ = nullptr;
    double value_ = 0;
    std::size_t group_ = 0;   ///< the next one
    std::uint64_t rows_ = 0;  ///< of the group at hand
    std::uint64_t row_ = 0;   ///< of it, the next
    std::uint64_t end_ = 0;   ///< of it, behind the last that is kept
    std::deque<ChunkReader> chunks_;
    std::optional<ChunkReader> keys_;
    Cell key_cell_;
};

}  // namespace etlc::recordings::parquet
