#include "recordings/parquet/written.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data/files/atomic_file.hpp"
#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "recordings/parquet/table.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

using diag::Code;
using diag::Failure;
using parquet::append;
using parquet::NewColumn;
using records::Tag;

void append_text(std::string& bytes, const std::string& text) {
    append(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += text;
}

/// Returns the values as the program reads them.
std::string given(const NewColumn& column) {
    std::string bytes;
    if (column.kind < NewColumn::Kind::language) {
        append(bytes, std::uint64_t{column.values.size()});
        return bytes + column.values;
    }
    append(bytes, std::uint64_t{column.lists.size()});
    for (const NewColumn::Run& run : column.lists) {
        append(bytes, run.rows);
        append(bytes, static_cast<std::uint32_t>(run.sayings.size()));
        for (const parquet::Saying& saying : run.sayings) {
            append(bytes, saying.timestamp);
            append_text(bytes, saying.content);
        }
    }
    return bytes;
}

/// Copies the first bytes of a file.
std::optional<Failure> copy(const std::string& from, std::uint64_t bytes, AtomicFile& to) {
    constexpr std::uint64_t kBlock = 1U << 20U;
    auto source = open_file(from);
    if (!source) return source.failure();
    std::string block;
    for (; bytes > 0; bytes -= block.size()) {
        block.resize(std::min(bytes, kBlock));
        const auto got = (*source)->read(block.data(), block.size());
        if (!got) return got.failure();
        if (*got < block.size())
            return Failure{Code::unreadable_parquet, "has changed while it was read"};
        if (auto failure = to.write(block)) return failure;
    }
    return std::nullopt;
}

std::optional<Failure> write(std::vector<std::string> words, const std::string& from,
                             const std::string& to, const std::string& head,
                             const std::vector<NewColumn>& columns) {
    for (const NewColumn& column : columns)
        words.push_back(std::to_string(static_cast<int>(column.kind)) + column.name);
    auto records = Table::start(from, words, true);
    if (!records) return records.failure();
    bool reads = (*records)->give(head);
    for (const NewColumn& column : columns) reads = reads && (*records)->give(given(column));
    (*records)->give_no_more();
    auto tag = (*records)->next();
    if (!tag) return tag.failure();
    const auto kept = parse_whole<std::uint64_t>((*records)->bytes());
    if (*tag != Tag::shapes || !kept || !reads) return (*records)->nonsense();
    auto file = AtomicFile::create(to, Code::unwritable_output);
    if (!file) return file.failure();
    if (auto failure = *kept > 0 ? copy(from, *kept, *file) : std::nullopt) return failure;
    for (tag = (*records)->next(); tag && *tag == Tag::rows; tag = (*records)->next())
        if (auto failure = file->write((*records)->bytes())) return failure;
    if (!tag) return tag.failure();
    if (*tag != Tag::end) return (*records)->nonsense();
    return file->commit();
}

}  // namespace

std::optional<Failure> write_extended(const std::string& from, const std::string& to,
                                      const std::vector<NewColumn>& columns) {
    return write({"extend", from}, from, to, "", columns);
}

std::optional<Failure> write_parquet(
    const std::string& to, std::uint64_t rows,
    const std::vector<std::pair<std::string, std::string>>& metadata,
    const std::vector<NewColumn>& columns) {
    std::string head;
    append(head, rows);
    append(head, static_cast<std::uint32_t>(metadata.size()));
    for (const auto& [key, value] : metadata) {
        append_text(head, key);
        append_text(head, value);
    }
    return write({"begin"}, "", to, head, columns);
}

}  // namespace etlc::recordings
