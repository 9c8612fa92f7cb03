#include "data/text/quote.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "diag/diag.hpp"
#include "source/escape.hpp"

namespace etlc::data {
namespace {

constexpr std::size_t kMaxQuoted = 60;  ///< bytes
constexpr std::size_t kMaxListed = 10;

}  // namespace

std::string in_quotes(std::string_view text) {
    if (text.size() <= kMaxQuoted) return fmt::format("'{}'", source::visible(text));
    std::size_t cut = kMaxQuoted;
    while (cut > kMaxQuoted - 4 && (static_cast<unsigned char>(text[cut]) & 0xC0U) == 0x80U) --cut;
    return fmt::format("'{}...'", source::visible(text.substr(0, cut)));
}

std::string listed(const std::vector<std::string>& names) {
    std::string result;
    const std::size_t shown = std::min(names.size(), kMaxListed);
    const std::size_t hidden = names.size() - shown;
    for (std::size_t i = 0; i < shown; ++i) {
        if (i > 0) result += i + 1 == shown && hidden == 0 ? " and " : ", ";
        result += in_quotes(names[i]);
    }
    if (hidden > 0) result += fmt::format(" and {} more", hidden);
    return result;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
    const auto nearest = diag::nearest_name(name, candidates);
    return nearest ? fmt::format("; did you mean {}?", in_quotes(*nearest)) : "";
}

}  // namespace etlc::data
