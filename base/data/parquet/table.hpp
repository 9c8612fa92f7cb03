// Rows of a Parquet file, as etlc-read-parquet gives them.
// Takes: a file and the names of columns. Gives: their cells, a row at a time. Keeps true: whatever
// the file does to the reader, here it is a failure that does not repeat the path; memory does not
// grow with the number of rows.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "data/records/records.hpp"
#include "diag/diag.hpp"

namespace etlc::data {

class Table {
public:
    /// A column that was asked for.
    struct Column {
        bool is_there = false;
        bool is_text = false;
        bool is_bool = false;
        bool is_list = false;
    };
    struct Cell {
        bool is_null = true;          ///< or its column is not there
        std::vector<double> numbers;  ///< one, or those of a list; NaN: a null in it
        std::vector<std::string> texts;
    };

    /// `key`: only the rows where this column is `value`; empty: all.
    static diag::Result<std::unique_ptr<Table>> open(const std::string& path,
                                                     const std::vector<std::string>& names,
                                                     const std::string& key = "",
                                                     std::uint64_t value = 0);

    const std::vector<Column>& columns() const { return columns_; }

    /// A cell for each name; false behind the last row.
    diag::Result<bool> next(std::vector<Cell>& cells);

private:
    Table(std::shared_ptr<Records> records, std::vector<Column> columns)
        : records_(std::move(records)), columns_(std::move(columns)) {}

    bool read_cell(const Column& column, Cell& cell);
    template <class T>
    bool take(T& value);

    std::shared_ptr<Records> records_;
    std::vector<Column> columns_;
    std::string_view block_;  ///< what is left of the record
    bool has_ended_ = false;
};

}  // namespace etlc::data
