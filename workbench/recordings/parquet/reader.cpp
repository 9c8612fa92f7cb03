// etlc-read-parquet: reads Parquet files in a separate process, since they may be hostile.
// It speaks the protocol of recordings/records/protocol.hpp.
// Keeps true: its own memory, files and time are limited before a byte of the file is looked at.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/parquet/chunk.hpp"
#include "recordings/parquet/rows.hpp"
#include "recordings/records/protocol.hpp"

namespace {

using namespace etlc::recordings;
using records::Cause;
using records::Tag;

/// Maps the whole file; its pages are loaded when they are read.
std::string_view map_file(const char* path) {
    const int descriptor = ::open(path, O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (descriptor < 0 || ::fstat(descriptor, &status) != 0)
        records::fail(Cause::file, "cannot be read");
    const auto size = static_cast<std::size_t>(status.st_size);
    if (size == 0) records::fail(Cause::file, "is empty");
    void* const bytes = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (bytes == MAP_FAILED) records::fail(Cause::file, "cannot be read");
    return {static_cast<const char*>(bytes), size};
}

template <class T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_cell(std::string& bytes, const parquet::Cell& cell, const parquet::Column& column) {
    if (cell.is_null) return append(bytes, records::kNullCell);
    append(bytes, static_cast<std::uint32_t>(cell.count(column)));
    for (const double number : cell.numbers) append(bytes, number);
    for (const std::string& text : cell.texts) {
        append(bytes, static_cast<std::uint32_t>(text.size()));
        bytes += text;
    }
}

/// A column that cannot be read is reported with its first row, not here.
std::string shape_of(const parquet::Column* column) {
    if (column == nullptr) return "absent\n";
    if (!column->why_not.empty()) return "number\n";
    const bool is_bool = column->physical == parquet::Physical::boolean;
    const std::string kind = column->is_text() ? "text" : is_bool ? "bool" : "number";
    return kind + (column->is_list ? " list\n" : "\n");
}

void read(std::string_view file, const std::string& key, double value,
          const std::vector<std::string>& names) {
    parquet::Rows rows(file, names);
    if (!key.empty()) rows.keep(key, value);
    std::string shapes;
    for (const parquet::Column* column : rows.columns()) shapes += shape_of(column);
    records::send(Tag::shapes, shapes);
    std::string block;
    std::string row;
    std::vector<parquet::Cell> cells;
    while (rows.next(cells)) {
        std::size_t i = 0;
        row.clear();
        for (const parquet::Column* column : rows.columns())
            if (column != nullptr) append_cell(row, cells[i++], *column);
        if (row.size() > records::kMaxRecordBytes)
            records::fail(Cause::file, "has a row of more bytes than are read");
        if (!block.empty() && block.size() + row.size() > records::kBlockBytes) {
            records::send(Tag::rows, block);
            block.clear();
        }
        block += row;
    }
    if (!block.empty()) records::send(Tag::rows, block);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 5 || std::string_view(argv[1]) != "read") return 2;
    const std::string_view file = map_file(argv[2]);
    records::limit_resources(file.size());
    try {
        read(file, argv[3], std::strtod(argv[4], nullptr), {argv + 5, argv + argc});
    } catch (const parquet::Refused& refused) {
        records::fail(refused.cause(), refused.what());
    } catch (const std::bad_alloc&) {
        records::fail(Cause::file, "takes more memory than reading it may");
    }
    records::done();
}
