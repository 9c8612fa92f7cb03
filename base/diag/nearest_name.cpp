#include <algorithm>
#include <array>
#include <cctype>

#include "diag/diag.hpp"

namespace etlc::diag {

namespace {

/// Longer names are not misspelt but generated; comparing them would only cost time.
constexpr std::size_t kLongest = 64;
/// Costs are in half edits: another case of the same letter is half as far as another letter.
constexpr int kEdit = 2;
constexpr int kCase = 1;

int substitution(char a, char b) {
    if (a == b) return 0;
    const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    return lower(a) == lower(b) ? kCase : kEdit;
}

/// Damerau-Levenshtein distance with adjacent transpositions (optimal string alignment), in half
/// edits.
int distance(std::string_view a, std::string_view b) {
    std::array<std::array<int, kLongest + 1>, 3> rows{};
    for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = kEdit * static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        auto& row = rows[i % 3];
        const auto& above = rows[(i + 2) % 3];
        const auto& two_above = rows[(i + 1) % 3];
        row[0] = kEdit * static_cast<int>(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j] + kEdit, row[j - 1] + kEdit,
                               above[j - 1] + substitution(a[i - 1], b[j - 1])});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) row[j] = std::min(row[j], two_above[j - 2] + kEdit);
        }
    }
    return rows[a.size() % 3][b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view name,
                                        const std::vector<std::string>& candidates) {
    if (name.empty() || name.size() > kLongest) return std::nullopt;
    const std::string* best = nullptr;
    int best_distance = 0;
    for (const std::string& candidate : candidates) {
        if (candidate.empty() || candidate.size() > kLongest) continue;
        // One edit in three letters, rounded up from two letters on: `p1` may mean `p2`, but `a`
        // does not mean `b`.
        const auto longer = static_cast<int>(std::max(name.size(), candidate.size()));
        const int allowed = std::max(kCase, kEdit * ((longer + 1) / 3));
        const int difference = static_cast<int>(name.size()) - static_cast<int>(candidate.size());
        if (kEdit * std::abs(difference) > allowed) continue;
        const int found = distance(name, candidate);
        if (found > allowed || (best != nullptr && found >= best_distance)) continue;
        best = &candidate;
        best_distance = found;
    }
    return best != nullptr ? std::optional(*best) : std::nullopt;
}

}  // namespace etlc::diag
