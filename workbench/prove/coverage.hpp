// What of a generated class a proof has executed, as gcov counts it.
// Takes: the JSON of `gcov --json-format` about the program of a proof. Gives: for each line of the
// header that has code, how often it ran, and its branches.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::prove {

struct Line {
    std::uint32_t number = 0;         ///< from 1
    std::uint64_t count = 0;          ///< of all instances of templates
    std::vector<std::uint64_t> ways;  ///< how often each branch was taken; empty: it has none
};

/// Returns the lines of the file `name`, in order; nothing where the text has none of it.
std::optional<std::vector<Line>> coverage_of(const std::string& json, std::string_view name);

}  // namespace etlc::prove
