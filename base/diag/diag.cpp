#include "diag/diag.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <tuple>

namespace etlc::diag {

const std::vector<CodeInfo>& all_codes() {
    static const std::vector<CodeInfo> codes{
#define DIAGNOSTIC(code, severity, name, summary) \
    CodeInfo{#code, Severity::severity, #name, summary},
#include "diag/codes.def"
#undef DIAGNOSTIC
    };
    return codes;
}

const CodeInfo& info(Code code) {
    return all_codes()[static_cast<std::size_t>(code)];
}

Diagnostic& did_you_mean(Diagnostic& to, const std::string& word,
                         std::optional<source::Span> where) {
    to.meant = word;
    return to.note(where, fmt::format("did you mean '{}'?", word));
}

Diagnostic& Sink::report(Code code, source::Span span, std::string message) {
    return report(Diagnostic{code, std::move(message), span});
}

Diagnostic& Sink::report(Diagnostic diagnostic) {
    if (diagnostic.severity() == Severity::error) ++errors_;
    if (diagnostic.severity() == Severity::warning) ++warnings_;
    return diagnostics_.emplace_back(std::move(diagnostic));
}

void Sink::add(const Sink& other, const std::string& note) {
    for (const Diagnostic& found : other.diagnostics_) {
        Diagnostic& added = report(found);
        if (!note.empty()) added.note(note);
    }
}

void Sink::drop_warnings_of_spec() {
    std::erase_if(diagnostics_, [this](const Diagnostic& found) {
        return severity(found) == Severity::warning && found.file.empty();
    });
    warnings_ = static_cast<std::size_t>(std::count_if(
        diagnostics_.begin(), diagnostics_.end(),
        [](const Diagnostic& found) { return found.severity() == Severity::warning; }));
}

std::vector<Diagnostic> Sink::sorted() const {
    std::vector<Diagnostic> result = diagnostics_;
    // A stable sort keeps the order in which a stage found things at one place. A finding about the
    // whole spec has no span and comes first.
    std::stable_sort(result.begin(), result.end(), [](const Diagnostic& a, const Diagnostic& b) {
        // Findings in the spec have no file name, which sorts before every name.
        const auto place = [](const Diagnostic& d) {
            const std::uint32_t begin = d.span && d.file.empty() ? d.span->begin : 0;
            return std::tuple<const std::string&, std::uint32_t, std::uint32_t, std::uint32_t>(
                d.file, d.line, d.column, begin);
        };
        return place(a) < place(b);
    });
    return result;
}

std::string_view word(Severity severity) {
    return severity == Severity::error     ? "error"
           : severity == Severity::warning ? "warning"
                                           : "note";
}

std::string counted(std::uint64_t n, const std::string& noun) {
    return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
}

std::string alternatives(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += i + 1 < words.size() ? ", " : " or ";
        text += words[i];
    }
    return text;
}

namespace {

/// Longer names are generated rather than misspelt; comparing them would only cost time.
constexpr std::size_t kLongest = 64;
/// Costs are in half edits: the same letter in the other case costs half as much as another letter.
constexpr int kEdit = 2;
constexpr int kCase = 1;

int substitution(char a, char b) {
    if (a == b) return 0;
    const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    return lower(a) == lower(b) ? kCase : kEdit;
}

/// Returns the Damerau-Levenshtein distance with adjacent transpositions (optimal string
/// alignment), in half edits.
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
        // One edit in three letters is allowed, rounded up from two letters on: `p1` may mean `p2`,
        // but `a` does not mean `b`.
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
