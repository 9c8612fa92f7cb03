#include "recordings/parquet/rows.hpp"

#include <algorithm>
#include <cstdio>

namespace etlc::recordings::parquet {
namespace {

/// Returns a name from the file without bytes that control a terminal.
std::string quoted(const std::string& name) {
    constexpr std::size_t kMost = 100;
    std::string text = "'";
    for (const char c : name.substr(0, kMost)) {
        char escape[8] = {c};
        if (c < 0x20 || c >= 0x7f)
            std::snprintf(escape, sizeof escape, "\\x%02x", static_cast<unsigned char>(c));
        text += escape;
    }
    return text + (name.size() > kMost ? "...'" : "'");
}

/// Adds the name of the column to a refusal.
template <class Read>
auto of_column(const Column& column, Read read) {
    try {
        return read();
    } catch (const Refused& refused) {
        throw Refused(refused.cause(), "column " + quoted(column.name) + " " + refused.what());
    }
}

/// Finds a column that can be read.
const Chunk& chunk_of(const RowGroup& group, const Column& column) {
    if (!column.why_not.empty()) throw Refused(records::Cause::elements, column.why_not);
    return group.chunks[column.leaf];
}

}  // namespace

Rows::Rows(std::string_view file, const std::vector<std::string>& names)
    : file_(file), footer_(read_footer(file)) {
    for (const std::string& name : names) columns_.push_back(find(name));
}

const Column* Rows::find(const std::string& name) const {
    const Column* found = nullptr;
    for (const Column& column : footer_.columns) {
        if (column.name != name) continue;
        if (found != nullptr) refuse("has two columns " + quoted(name));
        found = &column;
    }
    return found;
}

void Rows::keep(const std::string& key, double value) {
    key_ = find(key);
    value_ = value;
    if (key_ == nullptr) throw Refused(records::Cause::channel, "has no column " + quoted(key));
    if (key_->is_list || key_->is_text())
        throw Refused(records::Cause::elements,
                      "column " + quoted(key) + " is not of numbers, one a row");
}

/// Skips the other columns where no row is wanted.
Rows::Span Rows::kept_in(const RowGroup& group) const {
    if (key_ == nullptr) return {0, group.rows};
    return of_column(*key_, [&] {
        ChunkReader keys(file_, *key_, chunk_of(group, *key_));
        Span span;
        std::uint64_t rows = 0;
        for (Cell cell; keys.next(cell); ++rows) {
            if (cell.is_null || cell.numbers[0] != value_) continue;
            if (span.end == 0) span.begin = rows;
            span.end = rows + 1;
        }
        if (rows != group.rows)
            refuse("has " + std::to_string(rows) + " rows, its row group has " +
                   std::to_string(group.rows));
        return span;
    });
}

bool Rows::begin_group() {
    for (; group_ < footer_.groups.size(); ++group_) {
        const RowGroup& group = footer_.groups[group_];
        const Span span = kept_in(group);
        if (span.begin == span.end) continue;
        rows_ = group.rows;
        row_ = span.begin;
        end_ = span.end;
        chunks_.clear();
        keys_.reset();
        for (const Column* column : columns_)
            if (column != nullptr)
                of_column(*column, [&] {
                    chunks_.emplace_back(file_, *column, chunk_of(group, *column));
                    chunks_.back().skip(row_);
                });
        if (key_ != nullptr)
            of_column(*key_, [&] {
                keys_.emplace(file_, *key_, chunk_of(group, *key_));
                keys_->skip(row_);
            });
        ++group_;
        return true;
    }
    return false;
}

bool Rows::is_kept() {
    if (!keys_) return true;
    return of_column(*key_, [&] {
        if (!keys_->next(key_cell_)) refuse("has fewer rows than its row group");
        return !key_cell_.is_null && key_cell_.numbers[0] == value_;
    });
}

/// Checks that no column has more rows.
void Rows::end_group() {
    if (end_ < rows_) return;
    std::size_t i = 0;
    for (const Column* column : columns_)
        if (column != nullptr)
            of_column(*column, [&] {
                if (chunks_[i++].next(key_cell_)) refuse("has more rows than its row group");
            });
}

bool Rows::next(std::vector<Cell>& cells) {
    for (;;) {
        if (row_ == end_) {
            if (end_ > 0) end_group();
            row_ = end_ = 0;
            if (!begin_group()) return false;
        }
        const bool kept = is_kept();
        ++row_;
        cells.resize(chunks_.size());
        std::size_t i = 0;
        for (const Column* column : columns_) {
            if (column == nullptr) continue;
            ChunkReader& chunk = chunks_[i];
            Cell& cell = cells[i++];
            of_column(*column, [&] {
                if (!chunk.next(cell))
                    refuse("has fewer rows than its row group, which has " + std::to_string(rows_));
            });
        }
        if (kept) return true;
    }
}

}  // namespace etlc::recordings::parquet
