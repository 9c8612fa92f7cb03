// Collects diagnostics and prints them. Each cause is reported once, and nothing is printed
// before a stage has reported everything that it finds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "source/source.hpp"

namespace etlc::diag {

enum class Severity : std::uint8_t { error, warning, note };

std::string_view word(Severity severity);

enum class Code : std::uint16_t {
#define DIAGNOSTIC(code, severity, name, summary) name,
#include "diag/codes.def"
#undef DIAGNOSTIC
};

/// One row of codes.def.
struct CodeInfo {
    std::string_view code;  ///< "E0204"
    Severity severity;
    std::string_view name;  ///< "unknown_name"
    std::string_view summary;
};
const CodeInfo& info(Code code);
const std::vector<CodeInfo>& all_codes();

struct Note {
    std::optional<source::Span> span;  ///< absent: a remark without a place
    std::string text;
};

/// One finding. Its place is a span of the spec, or another file, with line and column where they
/// are known.
struct Diagnostic {
    Code code;
    std::string message;
    std::optional<source::Span> span;  ///< in the spec
    std::string file;                  ///< a file other than the spec; empty: the spec
    std::uint32_t line = 0;            ///< in `file`, from 1; 0: unknown
    std::uint32_t column = 0;
    std::vector<Note> notes;
    /// Something is missing that may still be missing here; the finding is a note instead of an
    /// error.
    bool is_allowed = false;
    /// Replacement for `span`, where only one was probably meant.
    std::string meant{};

    Severity severity() const { return is_allowed ? Severity::note : info(code).severity; }
    Diagnostic& note(std::string text) { return note({}, std::move(text)); }
    Diagnostic& note(std::optional<source::Span> where, std::string text) {
        notes.push_back({where, std::move(text)});
        return *this;
    }
};

/// Adds the note "did you mean 'WORD'?". `where` is the declaration of the word.
Diagnostic& did_you_mean(Diagnostic& to, const std::string& word,
                         std::optional<source::Span> where = {});

/// Collects the findings of all stages, which get it by reference.
class Sink {
public:
    /// With -Werror, warnings refuse the spec too.
    explicit Sink(bool warnings_are_errors = false) : warnings_are_errors_(warnings_are_errors) {}

    /// The returned reference is valid until the next report.
    Diagnostic& report(Code code, source::Span span, std::string message);
    Diagnostic& report(Diagnostic diagnostic);

    /// Adds the findings of another sink, each with `note` unless that is empty.
    void add(const Sink& other, const std::string& note);

    /// Removes warnings about the spec: commands that only use a spec leave them to `etlc SPEC
    /// --check`. Warnings that are errors stay.
    void drop_warnings_of_spec();

    bool has_errors() const { return errors_ > 0; }
    /// Returns the severity, an error for warnings under -Werror.
    Severity severity(const Diagnostic& found) const {
        const Severity severity = found.severity();
        return warnings_are_errors_ && severity == Severity::warning ? Severity::error : severity;
    }
    /// Whether the spec is refused. Stages stop at errors only, so that the warnings of all stages
    /// are reported.
    bool refused() const { return has_errors() || (warnings_are_errors_ && warnings() > 0); }
    std::size_t errors() const { return errors_; }
    std::size_t warnings() const { return warnings_; }
    /// Returns the findings in the order of their places in the spec; those in other files come
    /// last.
    std::vector<Diagnostic> sorted() const;

private:
    std::vector<Diagnostic> diagnostics_;
    std::size_t errors_ = 0;
    std::size_t warnings_ = 0;
    bool warnings_are_errors_;
};

/// A problem with a file other than the spec, found by a stage that does not know why the file was
/// read.
struct Failure {
    Code code;
    /// names the array, what was found and what was expected; data::in_file adds the file
    std::string message;
    std::uint32_t line = 0;
    std::uint32_t column = 0;
};

/// A value, or the failure that prevented it.
template <class T>
class Result {
public:
    Result(T value) : content_(std::move(value)) {}  // NOLINT(google-explicit-constructor)
    Result(Failure failure)
        : content_(std::move(failure)) {}  // NOLINT(google-explicit-constructor)

    explicit operator bool() const { return content_.index() == 0; }
    T& operator*() { return std::get<0>(content_); }
    const T& operator*() const { return std::get<0>(content_); }
    T* operator->() { return &std::get<0>(content_); }
    const T* operator->() const { return &std::get<0>(content_); }
    const Failure& failure() const { return std::get<1>(content_); }

private:
    std::variant<T, Failure> content_;
};

/// Returns the candidate nearest to `name` by edit distance, if one is near enough to be meant.
std::optional<std::string> nearest_name(std::string_view name,
                                        const std::vector<std::string>& candidates);

/// Joins words as alternatives: "f32, f16 or i8".
std::string alternatives(const std::vector<std::string>& words);

/// Returns a count with its noun: "1 episode", "2 episodes".
std::string counted(std::uint64_t n, const std::string& noun);

// Prints diagnostics as text with carets (`spec.etl:12:24: error: ... [E0204]`, the source line, a
// caret under the span, then notes) or as JSON. The same findings give the same bytes.

enum class Colour { none, ansi };

std::string render_text(const source::File& spec, const Sink& sink, Colour colour = Colour::none);
/// {"diagnostics": [{"code", "severity", "message", "file", "line", "column", "end_line",
/// "end_column", "notes"}]}
std::string render_json(const source::File& spec, const Sink& sink);

}  // namespace etlc::diag
