// Writes Parquet files: new columns behind those of a file, or a file of new columns alone.
// Takes: the columns. Gives: a file, which etlc-read-parquet describes and etlc writes. Keeps true:
// the old bytes up to the footer are the first bytes of the new file; memory is that of the columns
// and of what they are packed to.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diag/diag.hpp"
#include "recordings/parquet/extend.hpp"

namespace etlc::recordings {

/// Writes `to`: the file `from` with these columns behind its own. Failures do not repeat the path.
std::optional<diag::Failure> write_extended(const std::string& from, const std::string& to,
                                            const std::vector<parquet::NewColumn>& columns);

/// Writes a file of these columns, with texts in its metadata.
std::optional<diag::Failure> write_parquet(
    const std::string& to, std::uint64_t rows,
    const std::vector<std::pair<std::string, std::string>>& metadata,
    const std::vector<parquet::NewColumn>& columns);

}  // namespace etlc::recordings
