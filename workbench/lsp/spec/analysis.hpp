// Open documents, and the compiler's analysis of each state of their text.
// Gives: the findings, names and model of `etlc SPEC --check`, in which missing files are notes.
// Keeps true: no file is written; each state of a text is analysed at most once, when it is needed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "check/check.hpp"
#include "diag/diag.hpp"
#include "lsp/spec/names.hpp"
#include "lsp/text/position.hpp"
#include "parse/memory.hpp"
#include "pipeline/compile.hpp"
#include "source/source.hpp"

namespace etlc::lsp {

struct Analysis {
    /// `read`: what was read of an earlier state; `known`: the files of the spec that were read.
    Analysis(std::string path, std::string text, Encoding encoding, parse::Memory& read,
             check::KnownMatrices& known);
    Analysis(const Analysis&) = delete;  // `lines` refers to `file`
    Analysis& operator=(const Analysis&) = delete;

    source::File file;
    Lines lines;
    diag::Sink sink;
    bool has_syntax_errors = false;
    Names names;
    check::Inspected checked;
};

/// The result of planning the monitors, which takes longer.
struct Planned {
    diag::Sink sink;
    std::optional<pipeline::Compiled> compiled;
};

/// Plans the monitors; nothing where the model is incomplete.
std::optional<Planned> plan(const Analysis& analysis);

/// A text that is open in the client.
class Document {
public:
    Document(std::string uri, std::string text, std::int64_t version, Encoding encoding);

    const std::string& uri() const { return uri_; }
    const std::string& text() const { return text_; }
    std::int64_t version() const { return version_; }

    void replace(std::string text);
    /// Replaces a range, whose ends may be in either order.
    void replace(Range range, std::string_view text);
    void set_version(std::int64_t version) { version_ = version; }
    /// Drops the analysis, since files that the spec loads may have changed.
    void forget();

    const Analysis& analysis();
    /// Returns the plan; null where the model is incomplete or not planned yet.
    const Planned* planned() const { return planned_ ? &*planned_ : nullptr; }
    void plan();

    /// The findings of this state, or of its planning, have not been published.
    bool is_news = true;
    bool is_planned = false;

private:
    std::string uri_;
    std::string text_;
    std::int64_t version_;
    Encoding encoding_;
    parse::Memory read_;
    check::KnownMatrices known_;
    std::unique_ptr<Analysis> analysis_;
    std::optional<Planned> planned_;
};

}  // namespace etlc::lsp
