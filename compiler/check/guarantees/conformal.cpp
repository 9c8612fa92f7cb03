#include "check/guarantees/conformal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <numeric>

#include "check/numbers/decimal.hpp"
#include "data/files/hash.hpp"

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

namespace {

using thresholds::Entry;
using Found = std::optional<Contradiction>;

/// Returns alpha in canonical form, shortened to fit a line.
std::string short_text(const std::string& alpha) {
    constexpr std::size_t kLongest = 40;
    const std::string text = Decimal::parse(alpha).text();
    return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

Found counts(const Entry& entry, const std::string& place) {
    const bool is_pair = entry.method == "f1" && entry.scores.size() == 2;
    const std::uint64_t kept = takes_groups(entry.method) ? entry.n : is_pair ? 2 : 1;
    if (entry.n == 0 || entry.n > kMaxScores)
        return Contradiction{
            fmt::format("'{}.n' is {}, expected a number of scores from 1", place, entry.n)};
    if (entry.scores.size() != kept)
        return Contradiction{fmt::format(
            "'{}.scores' has {}, expected {}", place, diag::counted(entry.scores.size(), "element"),
            takes_groups(entry.method) ? fmt::format("n of them, which is {}", kept)
            : entry.method == "f1"     ? "1 or 2: the chosen score and the next"
                                       : "1: the chosen score")};
    for (std::size_t i = 1; i < entry.scores.size(); ++i)
        if (entry.scores[i] < entry.scores[i - 1])
            return Contradiction{
                fmt::format("'{0}.scores[{1}]' is {2}, expected at least {3}, the score before it",
                            place, i, entry.scores[i], entry.scores[i - 1])};
    if (entry.method == "f1") return std::nullopt;
    const std::uint64_t k = rank(entry.alpha, entry.n);
    if (k > entry.n)
        return Contradiction{
            fmt::format("'{}.n' is {}, expected at least {}, which alpha = {} needs", place,
                        entry.n, scores_needed(entry.alpha), short_text(entry.alpha))};
    if (k != entry.k)
        return Contradiction{
            fmt::format("'{}.k' is {}, expected {}: the rank of alpha = {} among {}", place,
                        entry.k, k, short_text(entry.alpha), diag::counted(entry.n, "score"))};
    return std::nullopt;
}

/// Returns the first index whose hash occurs earlier.
std::optional<std::size_t> first_again(const std::vector<std::uint64_t>& hashes) {
    std::vector<std::uint32_t> order(hashes.size());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return hashes[a] != hashes[b] ? hashes[a] < hashes[b] : a < b;
    });
    std::optional<std::size_t> first;
    for (std::size_t i = 1; i < order.size(); ++i)
        if (hashes[order[i]] == hashes[order[i - 1]] && (!first || order[i] < *first))
            first = order[i];
    return first;
}

Found episodes_of(const Entry& entry, const std::string& place,
                  const std::vector<std::uint64_t>& episodes, const thresholds::GroupNames& names) {
    const std::string list = entry.against.empty() ? "episodes" : place + ".episodes";
    const std::uint64_t least = takes_groups(entry.method) ? entry.n : 1;
    if (episodes.size() < least)
        return Contradiction{fmt::format(
            "'{}' has {}, expected at least {}{}", list, diag::counted(episodes.size(), "element"),
            least,
            takes_groups(entry.method) ? fmt::format(": one for each score of '{}'", place) : "")};
    const thresholds::GroupCount count = thresholds::count_groups(episodes, names);
    if (takes_groups(entry.method) && count.groups < entry.n)
        return Contradiction{fmt::format(
            "'{}.n' is {}, expected at most {}, the number of groups that '{}' are in: each has "
            "one score",
            place, entry.n, count.groups, list)};
    const std::optional<std::size_t> again = first_again(episodes);
    if (!again) return std::nullopt;
    return Contradiction{
        fmt::format("'{}[{}]' is '{}', which occurs earlier; expected each episode once", list,
                    *again, data::hash_text(episodes[*again]))};
}

/// Returns the derivation of an F1-optimal threshold in words, and its value.
std::pair<std::string, float> f1_threshold(const Entry& entry, const std::string& place) {
    const auto score = static_cast<float>(entry.scores[0]);
    if (entry.scores.size() == 1)
        return {fmt::format("that is '{}.scores[0]', {:.9g}", place, score), score};
    const auto next = static_cast<float>(entry.scores[1]);
    return {
        fmt::format("halfway between the two '{}.scores', {:.9g} and {:.9g}", place, score, next),
        halfway(score, next).value_or(score)};
}

Found threshold(const Entry& entry, const std::string& place, bool upper_bound) {
    const auto from = [&]() -> std::pair<std::string, float> {
        if (entry.method == "f1") return f1_threshold(entry, place);
        const std::uint64_t at =
            takes_groups(entry.method) ? at_rank(entry.k, entry.n, upper_bound) : 0;
        const double score = entry.scores[at];
        return {fmt::format("the first float32 beyond '{}.scores[{}]', {:.17g}", place, at, score),
                beyond(score, upper_bound)};
    };
    const auto [words, expected] = from();
    if (entry.epsilon == expected) return std::nullopt;
    return Contradiction{fmt::format("'{}.epsilon' is {:.9g}, expected {:.9g}: {}", place,
                                     entry.epsilon, expected, words),
                         true};
}

}  // namespace

Found contradiction(const Entry& entry, const std::string& place, bool upper_bound,
                    const std::vector<std::uint64_t>& episodes,
                    const thresholds::GroupNames& groups) {
    if (Found found = counts(entry, place)) return found;
    if (Found found = episodes_of(entry, place, episodes, groups)) return found;
    return threshold(entry, place, upper_bound);
}

}  // namespace etlc::check
