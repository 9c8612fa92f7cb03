// New columns behind the old ones of a Parquet file.
// Takes: the footer of a file, and the values of new columns. Gives: what follows the old bytes up
// to their footer: the pages of the new columns, and a new footer. Keeps true: no old byte moves,
// so all offsets in the old footer stay right; row groups keep their rows; fields of the old footer
// that are not known here are copied. Source: parquet.thrift, Encodings.md.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace etlc::annotate {

/// A text from a time on, as LeRobot's language_persistent has them.
struct Saying {
    float timestamp = 0;
    std::string content;
};

/// A column and its values, one a row.
struct NewColumn {
    /// `language` is a list of structs {role, content, style, timestamp, camera, tool_calls} a row,
    /// `events` the same without times, empty in every row.
    enum class Kind : std::uint8_t { boolean, int64, float32, language, events };
    /// Successive rows with the same list.
    struct Run {
        std::uint64_t rows = 0;
        std::vector<Saying> sayings;
    };

    Kind kind = Kind::boolean;
    std::string name;
    std::string values;      ///< of numbers, in the machine's order; a byte for a bool
    std::vector<Run> lists;  ///< of texts
};

/// Adds the bytes of a number to the values of a column.
template <class Number>
void append(std::string& bytes, Number value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Returns the bytes that follow the first `kept` bytes of a file, at which its footer began, to
/// the end of the extended file. Each column has a value for each row. Throws Refused.
std::string extension(std::string_view footer, std::uint64_t kept,
                      const std::vector<NewColumn>& columns);

/// Returns the bytes of a file of one row group, with pairs of keys and values in its footer.
std::string new_file(std::uint64_t rows,
                     const std::vector<std::pair<std::string, std::string>>& metadata,
                     const std::vector<NewColumn>& columns);

}  // namespace etlc::annotate
