// Reads and extends Parquet: any bytes give cells or an error, in bounded memory.
#include <algorithm>
#include <string>
#include <vector>

#include "annotate/extend.hpp"
#include "fuzz_target.hpp"
#include "recordings/parquet/rows.hpp"

namespace {

using namespace etlc;
using namespace etlc::annotate;
using namespace etlc::recordings::parquet;

constexpr int kMostRows = 50;  // a header may declare any number of nulls

std::vector<std::string> names_in(std::string_view file) {
    std::vector<std::string> names = {"q"};
    for (const Column& column : read_footer(file).columns)
        if (names.size() < 8) names.push_back(column.name);
    return names;
}

/// `key`: only rows where this column is 1; empty: all rows.
void read(std::string_view file, const std::vector<std::string>& names, const std::string& key) {
    Rows rows(file, names);
    if (!key.empty() && rows.rows() < 10000) rows.keep(key, 1);
    std::vector<Cell> cells;
    for (int row = 0; row < kMostRows && rows.next(cells); ++row) {
        std::size_t at = 0;
        for (const Column* column : rows.columns()) {
            if (column == nullptr) continue;
            const Cell& cell = cells[at++];
            fuzz::require(cell.numbers.empty() || cell.texts.empty(), "a cell is of one kind");
            fuzz::require(column->is_list || cell.count(*column) == (cell.is_null ? 0 : 1),
                          "a cell that is no list has one value or none");
        }
        fuzz::require(at == cells.size(), "there is a cell for each column that is there");
    }
}

std::size_t footer_bytes(std::string_view file) {
    return Cursor(file.substr(file.size() - 8)).number<std::uint32_t>("its footer");
}

/// Adds a column of bools and one of subtasks, which are read back.
void extend(std::string_view file) {
    const Footer old = read_footer(file);
    if (old.rows > 10000) return;
    const std::size_t begin = file.size() - 8 - footer_bytes(file);
    const NewColumn added = {NewColumn::Kind::boolean, "added", std::string(old.rows, '\1'), {}};
    const NewColumn said = {NewColumn::Kind::language, "said", "", {{old.rows, {{0.5F, "go"}}}}};
    const std::string longer =
        std::string(file.substr(0, begin)) +
        extension(file.substr(begin, footer_bytes(file)), begin, {added, said});
    Rows rows(longer, {"added", "said.content"});
    fuzz::require(rows.rows() == old.rows, "an extended file has the rows that it had");
    std::vector<Cell> cells;
    while (rows.next(cells)) {
        fuzz::require(cells.at(0).numbers == std::vector<double>{1}, "a new value is read back");
        fuzz::require(cells.at(1).texts == std::vector<std::string>{"go"}, "a text is read back");
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string_view file = fuzz::text(bytes, size);
    try {
        const std::vector<std::string> names = names_in(file);
        for (const std::string& name : names) try {
                read(file, {name}, "");
                read(file, {name}, "k");
            } catch (const Refused& refused) {
                fuzz::require_printable(refused.what());
            }
        read(file, names, "");
        extend(file);
    } catch (const Refused& refused) {
        fuzz::require_printable(refused.what());
    }
    return 0;
}
