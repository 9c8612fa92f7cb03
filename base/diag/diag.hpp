// Diagnostics: collecting them. Rendering is in render.hpp.
// Takes: a code, a place, words. Gives: the list, in the order of their places.
// Keeps true: each cause is reported once; nothing is printed before a stage has reported all it
// finds.
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

std::string_view word(Severity severity);  ///< "error"

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

/// One finding. Its place is a span of the spec, or another file (with line and column where they
/// are known).
struct Diagnostic {
    Code code;
    std::string message;
    std::optional<source::Span> span;  ///< of the spec
    std::string file;                  ///< another file than the spec; empty: the spec
    std::uint32_t line = 0;            ///< of `file`, from 1; 0: unknown
    std::uint32_t column = 0;
    std::vector<Note> notes;
    /// What would be an error elsewhere, and is allowed here: something that is not there yet.
    bool is_allowed = false;
    /// What could stand in place of `span`, where there is one thing that was probably meant.
    std::string meant{};

    Severity severity() const { return is_allowed ? Severity::note : info(code).severity; }
    Diagnostic& note(std::string text) { return note({}, std::move(text)); }
    Diagnostic& note(std::optional<source::Span> where, std::string text) {
        notes.push_back({where, std::move(text)});
        return *this;
    }
};

/// Asks for `word` in place of the span. `where`: the place that has the word.
Diagnostic& did_you_mean(Diagnostic& to, const std::string& word,
                         std::optional<source::Span> where = {});

/// Collects what the stages find. Passed by reference through the pipeline.
class Sink {
public:
    /// -Werror: what warnings find is refused too.
    explicit Sink(bool warnings_are_errors = false) : warnings_are_errors_(warnings_are_errors) {}

    /// The returned reference is good until the next report.
    Diagnostic& report(Code code, source::Span span, std::string message);
    Diagnostic& report(Diagnostic diagnostic);

    /// What another sink has collected, each with this note; empty: none.
    void add(const Sink& other, const std::string& note);

    /// What was found in the spec and is no error, is not told: for commands that use a spec, of
    /// which `etlc SPEC --check` tells it. Warnings that are errors stay.
    void drop_warnings_of_spec();

    bool has_errors() const { return errors_ > 0; }
    /// Warnings count as what -Werror makes of them.
    Severity severity(const Diagnostic& found) const {
        const Severity severity = found.severity();
        return warnings_are_errors_ && severity == Severity::warning ? Severity::error : severity;
    }
    /// Whether nothing may come of the spec. Stages stop at errors, so that the warnings of all of
    /// them are told.
    bool refused() const { return has_errors() || (warnings_are_errors_ && warnings() > 0); }
    std::size_t errors() const { return errors_; }
    std::size_t warnings() const { return warnings_; }
    /// In the order of their places in the spec; those of other files last.
    std::vector<Diagnostic> sorted() const;

private:
    std::vector<Diagnostic> diagnostics_;
    std::size_t errors_ = 0;
    std::size_t warnings_ = 0;
    bool warnings_are_errors_;
};

/// What went wrong with a file other than the spec, found by a stage that does not know why the
/// file was read.
struct Failure {
    Code code;
    std::string message;  ///< names the array, what was found and what was expected; not the file
                          ///< (data::in_file adds it)
    std::uint32_t line = 0;
    std::uint32_t column = 0;
};

/// A value, or why there is none.
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

/// The candidate nearest to `name` by edit distance, where one is near enough to be meant.
std::optional<std::string> nearest_name(std::string_view name,
                                        const std::vector<std::string>& candidates);

/// What may stand at a place: "f32, f16 or i8".
std::string alternatives(const std::vector<std::string>& words);

/// "1 episode", "2 episodes".
std::string counted(std::uint64_t n, const std::string& noun);

}  // namespace etlc::diag
