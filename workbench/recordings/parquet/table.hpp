// The rows of a Parquet file, read by etlc-read-parquet.
// Takes: a file and the names of columns. Gives: their cells, a row at a time. Keeps true: a file
// that crashes the reader causes a failure here, which does not repeat the path; memory does not
// grow with the number of rows.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"
#include "recordings/records/records.hpp"

namespace etlc::recordings {

class Table {
public:
    /// A requested column.
    struct Column {
        bool exists = false;
        bool is_text = false;
        bool is_bool = false;
        bool is_list = false;
    };
    struct Cell {
        bool is_null = true;          ///< also where its column is missing
        std::vector<double> numbers;  ///< one, or the elements of a list; NaN for a null element
        std::vector<std::string> texts;
    };

    /// Opens a file. `key`: only the rows in which this column is `value` are read; empty: all.
    static diag::Result<std::unique_ptr<Table>> open(const std::string& path,
                                                     const std::vector<std::string>& names,
                                                     const std::string& key = "",
                                                     std::uint64_t value = 0);

    const std::vector<Column>& columns() const { return columns_; }

    /// Reads a cell for each name; false at the end.
    diag::Result<bool> next(std::vector<Cell>& cells);

private:
    Table(std::shared_ptr<Records> records, std::vector<Column> columns)
        : records_(std::move(records)), columns_(std::move(columns)) {}

    bool read_cell(const Column& column, Cell& cell);
    template <class T>
    bool take(T& value);

    std::shared_ptr<Records> records_;
    std::vector<Column> columns_;
    std::string_view block_;  ///< the rest of the record
    bool has_ended_ = false;
};

}  // namespace etlc::recordings
