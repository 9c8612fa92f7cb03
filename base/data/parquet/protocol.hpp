// What etlc-read-parquet and etlc say to each other, in the records of data/records/protocol.hpp.
// `read FILE KEY VALUE NAME...`: one `shapes` record, a line for each name, "absent", or "number",
// "bool" or "text", with " list" behind it where a row has a list; then `rows` records of the rows
// whose column KEY is VALUE, of all where KEY is empty. Of a row, cell by cell, of the columns that
// are there: how many values it has (32 bits; kNullCell: the cell is null), then each as a double,
// or as the length (32 bits) and the bytes of a text. All numbers are in the machine's order.
#pragma once

#include <cstdint>

namespace etlc::data::parquet {

inline constexpr std::uint32_t kNullCell = 0xffffffff;

}  // namespace etlc::data::parquet
