#include "driver/options/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>

#include "data/quote.hpp"
#include "diag/diag.hpp"
#include "library/recorder.hpp"

namespace etlc::driver {

std::string mistake_in_word(const std::string& found, const std::vector<std::string>& expected) {
    if (std::find(expected.begin(), expected.end(), found) != expected.end()) return "";
    const auto meant = diag::nearest_name(found, expected);
    return fmt::format("found {}, expected {}{}", data::in_quotes(found),
                       diag::alternatives(expected),
                       meant ? fmt::format("; did you mean '{}'?", *meant) : "");
}

std::string mistake_in_number(const std::string& found, std::uint64_t least, std::uint64_t most) {
    std::uint64_t number = 0;
    const char* end = found.data() + found.size();
    const auto [stop, error] = std::from_chars(found.data(), end, number);
    if (error == std::errc() && stop == end && least <= number && number <= most) return "";
    const bool bounded = most < std::numeric_limits<std::uint64_t>::max();
    return fmt::format("found {}, expected a whole number from {}{}", data::in_quotes(found), least,
                       bounded ? fmt::format(" to {}", most) : "");
}

std::string mistake_in_reason(const std::string& found) {
    constexpr std::size_t kLongest = 200;
    const bool has_words = std::any_of(found.begin(), found.end(),
                                       [](unsigned char c) { return std::isalnum(c) != 0; });
    const bool one_line = found.find_first_of("\n\r") == std::string::npos;
    if (has_words && one_line && found.size() <= kLongest) return "";
    return fmt::format("found {}, expected a reason in words, on one line of at most {} bytes",
                       data::in_quotes(found), kLongest);
}

std::string mistake_in_recorder(const std::string& found) {
    std::string why;
    library::parse_recorder(found, why);
    return why;
}

plan::RecorderRequest recorder(const std::string& text) {
    std::string unused;
    return *library::parse_recorder(text, unused);
}

CLI::Validator one_of(std::vector<std::string> words) {
    const std::string form = fmt::format("{}", fmt::join(words, "|"));
    return CLI::Validator(
        [words = std::move(words)](std::string& found) { return mistake_in_word(found, words); },
        form);
}

}  // namespace etlc::driver
