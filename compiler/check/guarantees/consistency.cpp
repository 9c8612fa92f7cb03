#include "check/guarantees/consistency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "check/guarantees/conformal.hpp"
#include "check/numbers/decimal.hpp"
#include "data/files/hash.hpp"
#include "data/traces/overlap.hpp"

namespace etlc::check {

namespace {

using thresholds::Entry;
using Found = std::optional<Contradiction>;

/// Whether the method keeps all scores, one per group of demonstrations; the others pool frames and
/// keep the chosen score, f1 also the next.
bool keeps_all(const Entry& entry) {
    return entry.method == "conformal" || entry.method == "adaptive";
}

/// Returns alpha in canonical form, shortened to fit a line.
std::string short_text(const std::string& alpha) {
    constexpr std::size_t kLongest = 40;
    const std::string text = Decimal::parse(alpha).text();
    return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

Found counts(const Entry& entry, const std::string& place) {
    const bool is_pair = entry.method == "f1" && entry.scores.size() == 2;
    const std::uint64_t kept = keeps_all(entry) ? entry.n : is_pair ? 2 : 1;
    if (entry.n == 0 || entry.n > kMaxScores)
        return Contradiction{
            fmt::format("'{}.n' is {}, expected a number of scores from 1", place, entry.n)};
    if (entry.scores.size() != kept)
        return Contradiction{fmt::format(
            "'{}.scores' has {}, expected {}", place, diag::counted(entry.scores.size(), "element"),
            keeps_all(entry)       ? fmt::format("n of them, which is {}", kept)
            : entry.method == "f1" ? "1 or 2: the chosen score and the next"
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
    const std::uint64_t least = keeps_all(entry) ? entry.n : 1;
    if (episodes.size() < least)
        return Contradiction{fmt::format(
            "'{}' has {}, expected at least {}{}", list, diag::counted(episodes.size(), "element"),
            least, keeps_all(entry) ? fmt::format(": one for each score of '{}'", place) : "")};
    const thresholds::GroupCount count = thresholds::count_groups(episodes, names);
    if (keeps_all(entry) && count.groups < entry.n)
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
        const std::uint64_t at = keeps_all(entry) ? at_rank(entry.k, entry.n, upper_bound) : 0;
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

std::optional<std::uint64_t> shared_episode(const std::vector<std::uint64_t>& episodes,
                                            const thresholds::File& file) {
    const auto sorted = [](std::vector<std::uint64_t> hashes) {
        std::sort(hashes.begin(), hashes.end());
        return hashes;
    };
    const std::vector<std::uint64_t> known = sorted(file.episodes);
    const std::vector<std::uint64_t> asked = sorted(episodes);
    using Content = data::EpisodeContent;

    data::Suspects suspects(false);
    file.recordings.for_each_of(known,
                                [&](std::uint64_t, const Content& of) { suspects.know(of); });
    file.recordings.for_each_of(asked, [&](std::uint64_t, const Content& of) { suspects.ask(of); });
    const std::vector<bool> is_suspect = suspects.find();
    auto next = is_suspect.begin();
    data::Recordings recordings;
    file.recordings.for_each_of(known, [&](std::uint64_t, const Content& content) {
        if (*next++) recordings.add(content);
    });
    std::vector<std::uint64_t> overlapping;  // ascending
    file.recordings.for_each_of(asked, [&](std::uint64_t hash, const Content& content) {
        const auto overlap = *next++ ? recordings.find(content) : std::nullopt;
        if (overlap && (overlap->equal || file.allowances.empty())) overlapping.push_back(hash);
    });
    const auto group_of = [&](std::uint64_t episode) {
        const auto group = file.groups.find(data::hash_text(episode));
        return group == file.groups.end() ? std::string() : group->second;
    };
    std::set<std::string> groups;
    for (const std::uint64_t episode : known) groups.insert(group_of(episode));
    groups.erase("");
    const auto found = std::find_if(episodes.begin(), episodes.end(), [&](std::uint64_t episode) {
        return std::binary_search(known.begin(), known.end(), episode) ||
               std::binary_search(overlapping.begin(), overlapping.end(), episode) ||
               (file.allowances.empty() && groups.contains(group_of(episode)));
    });
    return found != episodes.end() ? std::optional(*found) : std::nullopt;
}

}  // namespace etlc::check
