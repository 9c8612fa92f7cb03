// Text from files, quoted for messages: control characters and broken UTF-8 escaped, long text cut
// short. Keeps true: a hostile file cannot send terminal escapes or megabytes through a diagnostic.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace etlc::data {

/// Quotes a text: 'text'.
std::string in_quotes(std::string_view text);

/// Lists names: 'a', 'b' and 'c'; for a long list the first few and a count.
std::string listed(const std::vector<std::string>& names);

/// Returns "; did you mean 'goal'?" where a candidate is near the name, else nothing.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace etlc::data
