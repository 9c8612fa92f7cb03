#include "check/guarantees/conformal.hpp"

#include <cfloat>
#include <cmath>
#include <limits>

#include "check/numbers/decimal.hpp"

namespace etlc::check {

namespace {

/// Returns floor(alpha * factor), multiplied digit by digit from the last: with alpha = 0.d1 d2 ...
/// the carry out of d1 is the part before the point.
std::uint64_t whole_part_of_product(const Decimal& alpha, std::uint64_t factor) {
    std::uint64_t carry = 0;
    for (std::size_t i = alpha.digits.size(); i-- > 0;)
        carry = (static_cast<std::uint64_t>(alpha.digits[i] - '0') * factor + carry) / 10;
    for (std::int64_t zeros = alpha.exponent; zeros < 0 && carry > 0; ++zeros) carry /= 10;
    return carry;
}

}  // namespace

std::uint64_t rank(std::string_view alpha, std::uint64_t n) {
    return n + 1 - whole_part_of_product(Decimal::parse(alpha), n + 1);
}

std::uint64_t scores_needed(std::string_view alpha) {
    std::uint64_t low = 1;
    std::uint64_t high = kMaxScores;
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (rank(alpha, middle) <= middle)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

float strictly_above(double high) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const double least = high + static_cast<double>(FLT_MIN);
    if (!(least < static_cast<double>(FLT_MAX))) return kInfinity;
    return std::nextafter(round_down(least), kInfinity);
}

float beyond(double score, bool upper_bound) {
    return upper_bound ? strictly_above(score) : 0.0F - strictly_above(-score);
}

std::optional<float> halfway(float low, float high) {
    if (!(std::nextafter(low, high) < high)) return std::nullopt;
    // If a float32 lies between them, it is nearer to the middle than either.
    return static_cast<float>((static_cast<double>(low) + static_cast<double>(high)) / 2);
}

}  // namespace etlc::check
