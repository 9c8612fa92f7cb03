#include "diag/diag.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <tuple>

#include "source/text.hpp"

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

namespace {

/// Diagnostics printed as text; the summary counts all of them.
constexpr std::size_t kMaxShown = 200;

/// Columns printed of a longer line.
constexpr std::size_t kWindow = 120;
constexpr std::size_t kContextBefore = 40;
constexpr std::string_view kReplacement = "\xEF\xBF\xBD";
constexpr std::string_view kEllipsis = "...";

/// One character of a line: its bytes, and the number of columns that it takes.
struct Cell {
    std::string_view bytes;
    std::size_t offset;  ///< in the line
    std::uint8_t width;
};

/// Returns the columns of a code point, after Unicode's East Asian Width and the general categories
/// Mn and Cf, by their main blocks.
std::uint8_t width_of(char32_t c) {
    static constexpr std::array<source::CodePoints, 8> kZero{{{0x300, 0x36F},
                                                              {0x483, 0x489},
                                                              {0x591, 0x5BD},
                                                              {0x610, 0x61A},
                                                              {0x64B, 0x65F},
                                                              {0x200B, 0x200F},
                                                              {0x20D0, 0x20FF},
                                                              {0xFE00, 0xFE0F}}};
    static constexpr std::array<source::CodePoints, 10> kWide{{{0x1100, 0x115F},
                                                               {0x2E80, 0x303E},
                                                               {0x3041, 0x33FF},
                                                               {0x3400, 0x4DBF},
                                                               {0x4E00, 0x9FFF},
                                                               {0xA000, 0xA4CF},
                                                               {0xAC00, 0xD7A3},
                                                               {0xF900, 0xFAFF},
                                                               {0xFF00, 0xFF60},
                                                               {0x1F300, 0x1FAFF}}};
    if (source::is_in(kZero, c)) return 0;
    return source::is_in(kWide, c) || (c >= 0x20000 && c <= 0x3FFFD) ? 2 : 1;
}

std::vector<Cell> cells_of(std::string_view line, std::size_t offset) {
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < line.size();) {
        const std::size_t length = source::utf8_length(line.substr(i));
        const std::string_view bytes = line.substr(i, length == 0 ? 1 : length);
        const char32_t value = length == 0 ? U'\0' : source::code_point(bytes);
        const bool shown = value == U'\t' || !source::is_hidden(value);
        cells.push_back(
            {shown ? bytes : kReplacement, offset + i, shown ? width_of(value) : std::uint8_t{1}});
        i += bytes.size();
    }
    return cells;
}

/// The part of a long line that is decoded; a line may have megabytes.
struct Part {
    std::size_t begin;
    std::size_t end;
};

/// Moves back to the first byte of a character, at most three bytes, since the text may not be
/// UTF-8.
std::size_t character_begin(std::string_view line, std::size_t at) {
    for (int i = 0; i < 3 && at > 0 && at < line.size() && source::is_continuation(line[at]); ++i)
        --at;
    return at;
}

Part part_around(std::string_view line, std::size_t at) {
    if (line.size() <= kWindow) return {0, line.size()};
    const std::size_t end_at_most = line.size() - kWindow;
    const std::size_t begin =
        character_begin(line, std::min(at > kContextBefore ? at - kContextBefore : 0, end_at_most));
    return {begin, character_begin(line, std::min(line.size(), begin + kWindow))};
}

/// A source line and its carets, as a terminal shows them. The carets stand under the span whatever
/// the line holds (tabs, wide and combining characters, bytes that are not UTF-8), and both lines
/// have a bounded width.
struct SourceView {
    /// The line, or the part around the span between "..." where it is very long.
    std::string text;
    std::string carets;  ///< blanks (tabs where the line has them), then ^~~~
};

SourceView view(const source::File& file, source::Span span) {
    const std::uint32_t line_number = file.position(span.begin).line;
    const std::string_view line = file.line_text(line_number);
    const std::size_t begin =
        std::min<std::size_t>(span.begin - file.line_begin(line_number), line.size());
    const std::size_t past = std::max(span.begin, span.end) - file.line_begin(line_number);
    const std::size_t end =
        std::clamp<std::size_t>(past, begin, line.size());  // only the first line of a longer span

    const Part part = part_around(line, begin);
    SourceView result;
    if (part.begin > 0) result = {std::string(kEllipsis), std::string(kEllipsis.size(), ' ')};
    bool started = false;
    for (const Cell& cell : cells_of(line.substr(part.begin, part.end - part.begin), part.begin)) {
        result.text += cell.bytes;
        if (cell.offset < begin) {
            result.carets += cell.bytes == "\t" ? std::string("\t") : std::string(cell.width, ' ');
        } else if (!started || cell.offset < end) {
            const std::size_t width = std::max<std::size_t>(cell.width, 1);
            result.carets += std::string(width, '~');
            if (!started) result.carets[result.carets.size() - width] = '^';
            started = true;
        }
    }
    if (!started) result.carets += '^';  // just after the last character of the line
    if (part.end < line.size()) result.text += kEllipsis;
    return result;
}

struct Palette {
    std::string_view bold, error, warning, note, caret, reset;
};
constexpr Palette kPlain{};
constexpr Palette kColours{"\x1b[1m",    "\x1b[1;31m", "\x1b[1;35m",
                           "\x1b[1;36m", "\x1b[1;32m", "\x1b[0m"};

class TextRenderer {
public:
    TextRenderer(const source::File& spec, Colour colour)
        : spec_(spec), palette_(colour == Colour::ansi ? kColours : kPlain) {}

    void add(const Diagnostic& diagnostic, Severity severity) {
        const std::string_view colour = severity == Severity::error     ? palette_.error
                                        : severity == Severity::warning ? palette_.warning
                                                                        : palette_.note;
        const bool in_spec = diagnostic.file.empty();
        headline(in_spec ? place(diagnostic.span) : place(diagnostic), word(severity), colour,
                 fmt::format("{} [{}]", source::visible(diagnostic.message),
                             info(diagnostic.code).code));
        if (in_spec && diagnostic.span) source_lines(*diagnostic.span);
        if (!in_spec && diagnostic.span) note({diagnostic.span, "named here"});
        for (const Note& n : diagnostic.notes) note(n);
    }

    void add_summary(const std::vector<Severity>& all, std::size_t left_out) {
        if (left_out > 0) text_ += fmt::format("({} more not shown)\n", left_out);
        std::string counts;
        for (const Severity severity : {Severity::error, Severity::warning, Severity::note}) {
            const auto n = static_cast<std::uint64_t>(std::count(all.begin(), all.end(), severity));
            if (n > 0)
                counts += (counts.empty() ? "" : ", ") + counted(n, std::string(word(severity)));
        }
        text_ += counts + '\n';
    }

    std::string take() { return std::move(text_); }

private:
    std::string place(const std::optional<source::Span>& span) const {
        const std::string path = source::visible(spec_.path());
        if (!span) return path;
        const source::Position at = spec_.position(span->begin);
        return fmt::format("{}:{}:{}", path, at.line, at.column);
    }

    static std::string place(const Diagnostic& diagnostic) {
        std::string result = source::visible(diagnostic.file);
        if (diagnostic.line > 0) result += fmt::format(":{}", diagnostic.line);
        if (diagnostic.line > 0 && diagnostic.column > 0)
            result += fmt::format(":{}", diagnostic.column);
        return result;
    }

    void headline(const std::string& where, std::string_view kind, std::string_view colour,
                  const std::string& words) {
        text_ += fmt::format("{0}{1}:{5} {2}{3}:{5} {0}{4}{5}\n", palette_.bold, where, colour,
                             kind, words, palette_.reset);
    }

    void source_lines(source::Span span) {
        const SourceView shown = view(spec_, span);
        text_ += fmt::format("{:5} | {}\n", spec_.position(span.begin).line, shown.text);
        const std::size_t first = shown.carets.find('^');
        text_ += fmt::format("      | {}{}{}{}\n", shown.carets.substr(0, first), palette_.caret,
                             shown.carets.substr(first), palette_.reset);
    }

    void note(const Note& n) {
        if (!n.span) {
            text_ += fmt::format("      = {}note:{} {}\n", palette_.note, palette_.reset,
                                 source::visible(n.text));
            return;
        }
        headline(place(n.span), "note", palette_.note, source::visible(n.text));
        source_lines(*n.span);
    }

    const source::File& spec_;
    const Palette& palette_;
    std::string text_;
};

}  // namespace

std::string render_text(const source::File& spec, const Sink& sink, Colour colour) {
    const std::vector<Diagnostic> all = sink.sorted();
    if (all.empty()) return {};
    TextRenderer renderer(spec, colour);
    const std::size_t shown = std::min(all.size(), kMaxShown);
    std::vector<Severity> severities;
    for (const Diagnostic& found : all) severities.push_back(sink.severity(found));
    for (std::size_t i = 0; i < shown; ++i) renderer.add(all[i], severities[i]);
    renderer.add_summary(severities, all.size() - shown);
    return renderer.take();
}

namespace {

using Json = nlohmann::ordered_json;

/// Line, column, end_line and end_column; 0 where unknown. The end is just after the span.
using Place = std::array<std::uint32_t, 4>;

Place place_of(const source::File& spec, const std::optional<source::Span>& span) {
    if (!span) return {};
    const source::Position begin = spec.position(span->begin);
    const source::Position end = spec.position(std::max(span->begin, span->end));
    return {begin.line, begin.column, end.line, end.column};
}

void add_place(Json& to, const std::string& file, const Place& place) {
    constexpr std::array kKeys{"line", "column", "end_line", "end_column"};
    to["file"] = file;
    for (std::size_t i = 0; i < kKeys.size(); ++i)
        to[kKeys[i]] = place[i] > 0 ? Json(place[i]) : Json();
}

Json note_of(const source::File& spec, const Note& note) {
    Json result;
    result["message"] = note.text;
    add_place(result, spec.path(), place_of(spec, note.span));
    return result;
}

Json diagnostic_of(const source::File& spec, const Diagnostic& diagnostic, Severity severity) {
    Json result;
    result["code"] = info(diagnostic.code).code;
    result["name"] = info(diagnostic.code).name;
    result["severity"] = word(severity);
    result["message"] = diagnostic.message;
    const bool in_spec = diagnostic.file.empty();
    if (in_spec)
        add_place(result, spec.path(), place_of(spec, diagnostic.span));
    else
        add_place(result, diagnostic.file,
                  {diagnostic.line, diagnostic.line > 0 ? diagnostic.column : 0});
    result["notes"] = Json::array();
    if (!in_spec && diagnostic.span)
        result["notes"].push_back(note_of(spec, {diagnostic.span, "named here"}));
    for (const Note& n : diagnostic.notes) result["notes"].push_back(note_of(spec, n));
    return result;
}

}  // namespace

std::string render_json(const source::File& spec, const Sink& sink) {
    Json all = Json::array();
    for (const Diagnostic& diagnostic : sink.sorted())
        all.push_back(diagnostic_of(spec, diagnostic, sink.severity(diagnostic)));
    Json document;
    document["diagnostics"] = std::move(all);
    // Paths and quoted words may hold any bytes; those that are not UTF-8 become U+FFFD.
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace etlc::diag
