#include "recordings/parquet/table.hpp"

#include <cstring>
#include <optional>

#include "data/files/file.hpp"
#include "recordings/records/protocol.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

using diag::Code;
using diag::Failure;
using records::Tag;

constexpr Records::Codes kCodes = {Code::unreadable_parquet, Code::unreadable_parquet,
                                   Code::no_such_channel, Code::unreadable_parquet};

std::optional<std::vector<Table::Column>> parse_columns(std::string_view text, std::size_t count) {
    std::vector<Table::Column> columns;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) return {};
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end + 1);
        Table::Column column;
        column.is_list = line.ends_with(" list");
        if (column.is_list) line.remove_suffix(5);
        column.exists = line != "absent";
        column.is_text = line == "text";
        column.is_bool = line == "bool";
        if (column.exists && !column.is_text && !column.is_bool && line != "number") return {};
        columns.push_back(column);
    }
    if (columns.size() != count) return {};
    return columns;
}

}  // namespace

diag::Result<std::unique_ptr<Table>> Table::open(const std::string& path,
                                                 const std::vector<std::string>& names,
                                                 const std::string& key, std::uint64_t value) {
    std::vector<std::string> arguments = {"read", path, key, std::to_string(value)};
    arguments.insert(arguments.end(), names.begin(), names.end());
    auto records = Records::start("etlc-read-parquet", "ETLC_PARQUET_READER", "Parquet", kCodes,
                                  path, arguments);
    if (!records) return records.failure();
    if (is_lfs_pointer(path)) return Failure{Code::unreadable_parquet, kIsLfsPointer};
    const auto tag = (*records)->next();
    if (!tag) return tag.failure();
    auto columns = parse_columns((*records)->bytes(), names.size());
    if (*tag != Tag::shapes || !columns) return (*records)->nonsense();
    return std::unique_ptr<Table>(new Table(std::move(*records), std::move(*columns)));
}

template <class T>
bool Table::take(T& value) {
    if (block_.size() < sizeof value) return false;
    std::memcpy(&value, block_.data(), sizeof value);
    block_.remove_prefix(sizeof value);
    return true;
}

bool Table::read_cell(const Column& column, Cell& cell) {
    cell.is_null = true;
    cell.numbers.clear();
    cell.texts.clear();
    if (!column.exists) return true;
    std::uint32_t count = 0;
    if (!take(count)) return false;
    cell.is_null = count == records::kNullCell;
    if (cell.is_null) return true;
    if (!column.is_list && count != 1) return false;
    if (!column.is_text) {
        if (count > block_.size() / sizeof(double)) return false;
        cell.numbers.resize(count);
        if (count > 0) std::memcpy(cell.numbers.data(), block_.data(), count * sizeof(double));
        block_.remove_prefix(count * sizeof(double));
        return true;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        std::uint32_t size = 0;
        if (!take(size) || size > block_.size()) return false;
        cell.texts.emplace_back(block_.substr(0, size));
        block_.remove_prefix(size);
    }
    return true;
}

diag::Result<bool> Table::next(std::vector<Cell>& cells) {
    if (has_ended_) return false;
    if (block_.empty()) {
        const auto tag = records_->next();
        if (!tag) return tag.failure();
        has_ended_ = *tag == Tag::end;
        if (has_ended_) return false;
        if (*tag != Tag::rows || records_->bytes().empty()) return records_->nonsense();
        block_ = records_->bytes();
    }
    cells.resize(columns_.size());
    for (std::size_t c = 0; c < columns_.size(); ++c)
        if (!read_cell(columns_[c], cells[c])) return records_->nonsense();
    return true;
}

}  // namespace etlc::recordings
