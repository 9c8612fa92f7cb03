// Open documents, and the compiler's analysis of each state of their text.
// Gives: the findings, names and model of `etlc SPEC --check`, in which missing files are notes.
// Keeps true: no file is written; each state of a text is analysed at most once, when it is needed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ast/ast.hpp"
#include "check/check.hpp"
#include "compile.hpp"
#include "diag/diag.hpp"
#include "lsp/spec/names.hpp"
#include "lsp/text/position.hpp"
#include "source/source.hpp"

namespace etlc::lsp {

class Analysis {
public:
    /// `known`: the files of the spec that were read.
    Analysis(std::string path, std::string text, Encoding encoding, check::KnownMatrices& known);
    Analysis(const Analysis&) = delete;  // `lines` refers to `file`
    Analysis& operator=(const Analysis&) = delete;

    /// The names of the spec, which only some requests need.
    const Names& names() const;

    source::File file;
    Lines lines;
    diag::Sink sink;
    ast::Spec spec;
    bool has_syntax_errors = false;
    std::unique_ptr<const check::Inspected> checked;

private:
    mutable std::optional<Names> names_;
};

struct Planned {
    diag::Sink sink;
    std::optional<Compiled> compiled;
};

/// A text that is open in the client.
class Document {
public:
    Document(std::string uri, std::string text, std::int64_t version, Encoding encoding);
    Document(const Document&) = delete;  // the analysis refers to itself
    Document& operator=(const Document&) = delete;

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
    /// Whether the model of this state is complete, and has no plan yet.
    bool needs_plan() const {
        return analysis_ && analysis_->checked->complete && planned_ == nullptr;
    }
    /// Returns the plan; null where the model is incomplete or not planned yet.
    const Planned* planned() const { return planned_.get(); }
    /// Plans the model, once.
    void plan();

    /// The findings of this state, or of its planning, have not been published.
    bool is_news = true;

private:
    std::string uri_;
    std::string text_;
    std::int64_t version_;
    Encoding encoding_;
    check::KnownMatrices known_;
    std::unique_ptr<Analysis> analysis_;
    std::unique_ptr<Planned> planned_;
};

}  // namespace etlc::lsp
