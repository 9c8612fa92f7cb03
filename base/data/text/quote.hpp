// Words from files, fit to stand in a message.
// Takes: any bytes. Gives: 'text' in quotes, control characters and broken UTF-8 escaped, long text
// cut short with an ellipsis. Keeps true: a hostile file cannot send terminal escapes or megabytes
// through a diagnostic.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace etlc::data {

std::string in_quotes(std::string_view text);

/// 'a', 'b' and 'c'; of a long list the first few and a count.
std::string listed(const std::vector<std::string>& names);

}  // namespace etlc::data
