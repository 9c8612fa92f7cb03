#include "diag/diag.hpp"

#include <fmt/format.h>

#include <algorithm>
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
    return report(Diagnostic{code, std::move(message), span, {}, 0, 0, {}});
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
    // Stable, so that what a stage found at one place stays in the order in which it was found. A
    // finding about the whole spec has no span and comes first.
    std::stable_sort(result.begin(), result.end(), [](const Diagnostic& a, const Diagnostic& b) {
        // The spec's own findings have no file name, which sorts before every name.
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
    switch (severity) {
        case Severity::error: return "error";
        case Severity::warning: return "warning";
        case Severity::note: break;
    }
    return "note";
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

}  // namespace etlc::diag
