#include "data/parquet/rows.hpp"

#include <algorithm>
#include <cstdio>

namespace etlc::data::parquet {
namespace {

/// A name from the file: what a terminal may be sent of it.
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

/// Says which column it is that refuses.
template <class Read>
auto of_column(const Column& column, Read read) {
    try {
        return read();
    } catch (const Refused& refused) {
        throw Refused(refused.cause(), "column " + quoted(column.name) + " " + refused.what());
    }
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

/// Whether any row of the group is kept; the others' columns need not be unpacked.
bool Rows::has_kept(const RowGroup& group) const {
    if (key_ == nullptr) return true;
    return of_column(*key_, [&] {
        ChunkReader keys(file_, *key_, group.chunks[key_->leaf]);
        std::uint64_t rows = 0;
        bool found = false;
        for (Cell cell; keys.next(cell); ++rows)
            found = found || (!cell.is_null && cell.numbers[0] == value_);
        if (rows != group.rows)
            refuse("has " + std::to_string(rows) + " rows, its row group has " +
                   std::to_string(group.rows));
        return found;
    });
}

bool Rows::begin_group() {
    for (; group_ < footer_.groups.size(); ++group_) {
        const RowGroup& group = footer_.groups[group_];
        if (group.rows == 0 || !has_kept(group)) continue;
        count_ = group.rows;
        row_ = 0;
        chunks_.clear();
        keys_.reset();
        for (const Column* column : columns_)
            if (column != nullptr)
                of_column(*column, [&] {
                    chunks_.emplace_back(file_, *column, group.chunks[column->leaf]);
                });
        if (key_ != nullptr)
            of_column(*key_, [&] { keys_.emplace(file_, *key_, group.chunks[key_->leaf]); });
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

void Rows::end_group() {
    std::size_t i = 0;
    for (const Column* column : columns_)
        if (column != nullptr)
            of_column(*column, [&] {
                if (chunks_[i++].pass_over()) refuse("has more rows than its row group");
            });
}

bool Rows::next(std::vector<Cell>& cells) {
    for (;;) {
        if (row_ == count_) {
            if (group_ > 0 && count_ > 0) end_group();
            count_ = 0;
            row_ = 0;
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
                if (!(kept ? chunk.next(cell) : chunk.pass_over()))
                    refuse("has fewer rows than its row group, which has " +
                           std::to_string(count_));
            });
        }
        if (kept) return true;
    }
}

}  // namespace etlc::data::parquet
