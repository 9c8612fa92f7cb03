// Open documents, and the compiler's analysis of each state of their text.
// Gives: the findings, names and model of `etlc SPEC --check`, in which missing files are notes.
// Keeps true: no file is written; each state of a text is analysed at most once, when it is needed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ast/ast.hpp"
#include "check/check.hpp"
#include "check/context/scope.hpp"
#include "compile.hpp"
#include "diag/diag.hpp"
#include "lsp/text/json.hpp"
#include "parse/stream/words.hpp"
#include "source/source.hpp"

namespace etlc::lsp {

// The occurrences of names in a spec: the declaration of each, and its uses.
// Takes: the tree, and the text of declarations that could not be parsed. Gives: occurrences in the
// order of the text. Keeps true: names share one scope, so equal names mean the same; a word that
// is not a name in its place (a unit, a method, the name of an argument) is no occurrence.

struct Occurrence {
    std::string name;
    source::Span span;
    bool declares = false;
    /// In quotes, as the key of frames(...), which also names an array of recordings.
    bool quoted = false;
    /// In a declaration that could not be parsed, so that it may be something else.
    bool uncertain = false;
    bool of_spec = false;  ///< the spec's own name, which is in no scope

    bool means_the_same(const Occurrence& other) const {
        return name == other.name && of_spec == other.of_spec;
    }
};

/// The kind of an input's samples, according to its declaration.
enum class Shape : std::uint8_t { embedding, scalar, boolean };

struct Declared {
    std::string name;
    /// Nothing for the spec itself.
    std::optional<check::NameKind> kind;
    source::Span name_span;
    source::Span span;  ///< of the whole declaration
    Shape shape = Shape::scalar;
    bool is_duration = false;  ///< a constant with a unit
};

/// A file that the spec names, and the place of the name.
struct NamedFile {
    std::string path;
    source::Span span;
};

struct Names {
    std::vector<Declared> declared;  ///< in the order of the text
    std::vector<Occurrence> occurrences;
    std::vector<NamedFile> files;
    /// The declarations that could be parsed.
    std::vector<source::Span> readable;
};

Names names_of(const ast::Spec& spec, const source::File& file);

/// Adds the words in declarations that could not be parsed which are names. `words`: all.
void add_uncertain(Names& names, const std::vector<parse::Word>& words, const source::File& file);

/// Finds the occurrence at `offset` or directly before it; null where there is none.
const Occurrence* occurrence_at(const Names& names, std::uint32_t offset);
/// Finds the first declaration of the name; null where there is none.
const Declared* declaration_of(const Names& names, const Occurrence& occurrence);

class Analysis {
public:
    /// `cache`: of the files that specs load.
    Analysis(std::string path, std::string text, Encoding encoding, check::MatrixCache& cache);
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
    check::MatrixCache cache_;
    std::unique_ptr<Analysis> analysis_;
    std::unique_ptr<Planned> planned_;
};

}  // namespace etlc::lsp
