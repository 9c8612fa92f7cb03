#include "check/guarantees/conformal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <numeric>

#include "check/guarantees/calibrated.hpp"
#include "check/numbers/decimal.hpp"
#include "data/files/hash.hpp"

namespace etlc::check {

namespace {

/// Losses are compared as multiples of 2^-kLossBits.
constexpr int kLossBits = 36;

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

float infinite(bool above) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return above ? kInfinity : -kInfinity;
}

bool keeps_risk(const std::vector<double>& losses, std::string_view alpha) {
    constexpr std::uint64_t kOne = std::uint64_t{1} << kLossBits;
    if (losses.size() >= kOne >> 13U) return false;  // the product below would overflow
    std::uint64_t sum = kOne;
    for (const double loss : losses)
        sum += static_cast<std::uint64_t>(std::ceil(loss * static_cast<double>(kOne)));
    return sum <= whole_part_of_product(Decimal::parse(alpha), (losses.size() + 1) * kOne);
}

Both both(float against_misses, float against_false_positives, bool upper_bound) {
    const float low = std::min(against_misses, against_false_positives);
    const float high = std::max(against_misses, against_false_positives);
    const bool overlap = (against_misses == high) == upper_bound && low < high;
    if (overlap) return {against_misses, against_false_positives};
    return {halfway(low, high).value_or(against_misses), std::nullopt};
}

namespace {

using thresholds::Entry;
using thresholds::Side;
using Found = std::optional<Contradiction>;

/// Returns alpha in canonical form, shortened to fit a line.
std::string short_text(const std::string& alpha) {
    constexpr std::size_t kLongest = 40;
    const std::string text = Decimal::parse(alpha).text();
    return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

/// One threshold of an entry, and what it has to be.
struct Checked {
    const Side& side;
    const std::string& method;
    const std::string& rate;
    std::string rate_name;  ///< "alpha"
    std::string place;      ///< "predicates.at_a.inner"
    bool above;             ///< is_above
    bool of_two;            ///< it may be infinite
};

Found in_order(const Checked& of) {
    const std::vector<double>& scores = of.side.scores;
    for (std::size_t i = 1; i < scores.size(); ++i)
        if (scores[i] < scores[i - 1])
            return Contradiction{
                fmt::format("'{0}.scores[{1}]' is {2}, expected at least {3}, the score before it",
                            of.place, i, scores[i], scores[i - 1])};
    return std::nullopt;
}

Found losses(const Checked& of) {
    const std::uint64_t n = of.method == "risk" ? of.side.n : 0;
    for (const auto& [key, list] : {std::pair{"losses", &of.side.losses},
                                    std::pair{"losses_before", &of.side.losses_before}}) {
        const bool may_be_empty = list == &of.side.losses_before;
        if (list->size() != n && !(may_be_empty && list->empty()))
            return Contradiction{fmt::format("'{}.{}' has {}, expected {}", of.place, key,
                                             diag::counted(list->size(), "element"), n)};
        for (std::size_t i = 0; i < list->size(); ++i)
            if (!((*list)[i] >= 0 && (*list)[i] <= 1))
                return Contradiction{fmt::format("'{}.{}[{}]' is {}, expected a share from 0 to 1",
                                                 of.place, key, i, (*list)[i])};
    }
    if (n == 0 && !of.of_two && of.method == "risk")
        return Contradiction{
            fmt::format("'{}.n' is 0, expected a number of scores from 1", of.place)};
    if (of.method != "risk" || std::isinf(of.side.epsilon)) return std::nullopt;
    if (!keeps_risk(of.side.losses, of.rate))
        return Contradiction{
            fmt::format("'{}.losses' are too great for {} = {}: expected n / (n + 1) mean + 1 / (n "
                        "+ 1) of them, which is at most that",
                        of.place, of.rate_name, short_text(of.rate))};
    if (!of.side.losses_before.empty() && keeps_risk(of.side.losses_before, of.rate))
        return Contradiction{
            fmt::format("'{}.losses_before' are small enough for {} = {}, so that the threshold "
                        "would be a tighter one",
                        of.place, of.rate_name, short_text(of.rate))};
    return std::nullopt;
}

Found counts(const Checked& of) {
    const auto& [side, method, rate, rate_name, place, above, of_two] = of;
    const bool is_infinite = std::isinf(side.epsilon);
    const bool is_pair = method == "f1" && side.scores.size() == 2;
    const std::uint64_t kept = takes_scores(method)              ? side.n
                               : method == "risk" && is_infinite ? 0
                               : is_pair                         ? 2
                                                                 : 1;
    if ((side.n == 0 && !of_two) || side.n > kMaxScores)
        return Contradiction{
            fmt::format("'{}.n' is {}, expected a number of scores from 1", place, side.n)};
    if (side.scores.size() != kept)
        return Contradiction{fmt::format(
            "'{}.scores' has {}, expected {}", place, diag::counted(side.scores.size(), "element"),
            takes_scores(method) ? fmt::format("n of them, which is {}", kept)
            : method == "f1"     ? "1 or 2: the chosen score and the next"
                                 : fmt::format("{}: the chosen score", kept))};
    if (Found found = in_order(of)) return found;
    if (Found found = losses(of)) return found;
    if (method == "f1" || method == "risk") return std::nullopt;
    const std::uint64_t k = rank(rate, side.n);
    if (k > side.n && !of_two)
        return Contradiction{fmt::format("'{}.n' is {}, expected at least {}, which {} = {} needs",
                                         place, side.n, scores_needed(rate), rate_name,
                                         short_text(rate))};
    if (k != side.k)
        return Contradiction{fmt::format("'{}.k' is {}, expected {}: the rank of {} = {} among {}",
                                         place, side.k, k, rate_name, short_text(rate),
                                         diag::counted(side.n, "score"))};
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
                  const std::vector<std::uint64_t>& episodes, const thresholds::GroupNames& names,
                  bool may_repeat) {
    const std::string list = place.starts_with("monitors") ? place + ".episodes" : "episodes";
    const std::uint64_t n = std::max(entry.n, entry.inner ? entry.inner->n : 0);
    const std::uint64_t least = takes_groups(entry.method) ? n : 1;
    if (episodes.size() < least)
        return Contradiction{fmt::format(
            "'{}' has {}, expected at least {}{}", list, diag::counted(episodes.size(), "element"),
            least,
            takes_groups(entry.method) ? fmt::format(": one for each score of '{}'", place) : "")};
    const thresholds::GroupCount count = thresholds::count_groups(episodes, names);
    if (takes_groups(entry.method) && count.groups < n)
        return Contradiction{fmt::format(
            "'{}.n' is {}, expected at most {}, the number of groups that '{}' are in: each has "
            "one score",
            place, n, count.groups, list)};
    const std::optional<std::size_t> again = first_again(episodes);
    if (!again || may_repeat) return std::nullopt;
    return Contradiction{
        fmt::format("'{}[{}]' is '{}', which occurs earlier; expected each episode once", list,
                    *again, data::hash_text(episodes[*again]))};
}

/// Returns the derivation of an F1-optimal threshold in words, and its value.
std::pair<std::string, float> f1_threshold(const Side& entry, const std::string& place) {
    const auto score = static_cast<float>(entry.scores[0]);
    if (entry.scores.size() == 1)
        return {fmt::format("that is '{}.scores[0]', {:.9g}", place, score), score};
    const auto next = static_cast<float>(entry.scores[1]);
    return {
        fmt::format("halfway between the two '{}.scores', {:.9g} and {:.9g}", place, score, next),
        halfway(score, next).value_or(score)};
}

Found threshold(const Checked& of) {
    const auto& [side, method, rate, rate_name, place, above, of_two] = of;
    const auto from = [&, &side = side, &method = method, &place = place,
                       above = above]() -> std::pair<std::string, float> {
        if (method == "f1") return f1_threshold(side, place);
        const bool too_few = method == "risk" ? side.scores.empty() : side.k > side.n;
        if (too_few)
            return {
                fmt::format("infinite, since the {} are too few", diag::counted(side.n, "score")),
                infinite(above)};
        const std::uint64_t at = takes_scores(method) ? at_rank(side.k, side.n, above) : 0;
        const double score = side.scores[at];
        return {fmt::format("the first float32 beyond '{}.scores[{}]', {:.17g}", place, at, score),
                beyond(score, above)};
    };
    const auto [words, expected] = from();
    if (side.epsilon == expected) return std::nullopt;
    return Contradiction{fmt::format("'{}.epsilon' is {:.9g}, expected {:.9g}: {}", place,
                                     side.epsilon, expected, words),
                         true};
}

Found duration_of(const Entry& entry, const std::string& place, bool longer_is_truer) {
    const std::uint64_t at = at_rank(entry.k, entry.n, longer_is_truer);
    const double expected = entry.scores[at];
    if (static_cast<double>(*entry.duration) == expected) return std::nullopt;
    return Contradiction{
        fmt::format("'{0}.duration' is {1}, expected {2}, which is '{0}.scores[{3}]'", place,
                    *entry.duration, expected, at)};
}

/// Returns what `against` says in the file.
Against against_of(const Entry& entry) {
    for (const Against against :
         {Against::false_positives, Against::missed_alarm, Against::missed_success, Against::both})
        if (entry.against == word(against)) return against;
    return Against::misses;
}

}  // namespace

Found contradiction(const Entry& entry, const std::string& place, bool upper_bound,
                    const std::vector<std::uint64_t>& episodes,
                    const thresholds::GroupNames& groups, bool may_repeat) {
    const bool of_two = entry.inner.has_value();
    const bool above = is_above(against_of(entry), upper_bound);
    std::vector<Checked> sides{{entry, entry.method, entry.alpha, "alpha", place, above, of_two}};
    if (of_two)
        sides.push_back({*entry.inner, entry.method, entry.beta.empty() ? entry.alpha : entry.beta,
                         entry.beta.empty() ? "alpha" : "beta", place + ".inner", !above, true});
    for (const Checked& side : sides)
        if (Found found = counts(side)) return found;
    if (Found found = episodes_of(entry, place, episodes, groups, may_repeat)) return found;
    const std::size_t measured = entry.measured.size();
    if (measured > 0 &&
        (measured != entry.n || !std::is_sorted(entry.measured.begin(), entry.measured.end())))
        return Contradiction{
            fmt::format("'{}.measured' has {}, expected n of them, which is {}, in ascending order",
                        place, diag::counted(measured, "element"), entry.n)};
    if (entry.duration) return duration_of(entry, place, upper_bound);
    for (const Checked& side : sides)
        if (Found found = threshold(side)) return found;
    if (!of_two || !std::isinf(entry.epsilon) || !std::isinf(entry.inner->epsilon))
        return std::nullopt;
    return Contradiction{
        fmt::format("both thresholds of '{}' are infinite, expected one that is "
                    "finite: the scores are too few",
                    place)};
}

}  // namespace etlc::check
