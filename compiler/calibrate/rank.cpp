#include "calibrate/rank.hpp"

#include "check/decimal.hpp"

namespace etlc::calibrate {

namespace {

/// floor(alpha * factor), digit by digit from the last: with alpha = 0.d1 d2 ... the carry out of d1 is what stands
/// before the point.
std::uint64_t whole_part_of_product(const check::Decimal& alpha, std::uint64_t factor) {
    std::uint64_t carry = 0;
    for (std::size_t i = alpha.digits.size(); i-- > 0;)
        carry = (static_cast<std::uint64_t>(alpha.digits[i] - '0') * factor + carry) / 10;
    for (std::int64_t zeros = alpha.exponent; zeros < 0 && carry > 0; ++zeros) carry /= 10;
    return carry;
}

}  // namespace

std::uint64_t rank(std::string_view alpha, std::uint64_t n) {
    return n + 1 - whole_part_of_product(check::Decimal::parse(alpha), n + 1);
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

}  // namespace etlc::calibrate
