// The footer of a Parquet file: its columns and the places of their values.
// Takes: the bytes of the file. Gives: the columns, with a reason for each that cannot be read.
// Keeps true: every place lies within the file; nothing is decompressed. Source:
// apache/parquet-format, parquet.thrift and LogicalTypes.md, 2.10.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::data::parquet {

enum class Physical : std::uint8_t {
    boolean = 0,
    int32 = 1,
    int64 = 2,
    int96 = 3,
    float32 = 4,
    float64 = 5,
    binary = 6,
    fixed = 7
};

/// A field of the table, or one of a struct in it: a value a row, or a list of values a row.
struct Column {
    std::string name;  ///< of a field of a struct "STRUCT.FIELD"; each part may have dots itself
    Physical physical = Physical::float32;
    bool is_unsigned = false;
    bool is_list = false;
    std::uint8_t most_defined = 0;     ///< the level of a value that is there; below it is null
    std::uint8_t element_level = 0;    ///< from this level on there is an element, of a list
    std::uint8_t null_list_level = 0;  ///< below this level the list itself is null
    std::string why_not;               ///< it is not read; empty: it is
    std::size_t leaf = 0;              ///< its place among the chunks of a row group

    bool is_text() const { return physical == Physical::binary; }
};

/// The values of a column in a row group.
struct Chunk {
    std::int64_t codec = 0;
    std::uint64_t values = 0;
    std::uint64_t begin = 0;  ///< in the file
    std::uint64_t bytes = 0;
    std::string why_not;  ///< it is not read; empty: it is
};

struct RowGroup {
    std::uint64_t rows = 0;
    std::vector<Chunk> chunks;  ///< by leaf
};

struct Footer {
    std::vector<Column> columns;
    std::vector<RowGroup> groups;
    std::uint64_t rows = 0;
};

/// Throws Refused.
Footer read_footer(std::string_view file);

inline constexpr std::uint64_t kMaxRows = 1ULL << 26U;
inline constexpr std::size_t kMaxFooterBytes = 64U << 20U;

}  // namespace etlc::data::parquet
