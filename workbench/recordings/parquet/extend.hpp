// New columns behind the old ones of a Parquet file.
// Takes: the bytes of a file, or none, and the values of new columns. Gives: what follows the old
// bytes up to their footer: the pages of the new columns, and a new footer. Keeps true: no old byte
// moves, so all offsets in the old footer stay right; row groups keep their rows; fields of the old
// footer that are not known here are copied. Source: parquet.thrift, Encodings.md.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recordings/parquet/footer.hpp"

namespace etlc::recordings::parquet {

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

/// Adds the bytes of a number to the values of a column, or to what the program reads.
template <class Number>
void append(std::string& bytes, Number value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Sends bytes of the file, in their order.
using Send = std::function<void(const std::string& bytes)>;

/// All functions throw Refused.
class Extension {
public:
    /// Extends a file, which outlives this object.
    explicit Extension(std::string_view file);
    /// Begins a file of one row group, with pairs of keys and values in its footer.
    Extension(std::uint64_t rows, const std::vector<std::pair<std::string, std::string>>& metadata);

    /// The number of old bytes that stay; what is sent follows them.
    std::uint64_t kept() const { return kept_; }
    /// Sends a column, which has a value for each row.
    void add(const NewColumn& column, const Send& send);
    /// Sends the footer.
    void end(const Send& send);

private:
    struct Metadata;

    void check(const NewColumn& column) const;

    Footer old_;
    std::uint64_t kept_ = 0;
    std::uint64_t at_ = 0;  ///< the end of what was sent, in the file
    std::shared_ptr<Metadata> metadata_;
};

}  // namespace etlc::recordings::parquet
