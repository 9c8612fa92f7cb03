#include "diag/render.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "diag/source_view.hpp"
#include "source/escape.hpp"

namespace etlc::diag {

namespace {

/// Diagnostics shown in the text form; the summary counts them all.
constexpr std::size_t kMaxShown = 200;

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

}  // namespace etlc::diag
