// The occurrences of names in a spec: the declaration of each, and its uses.
// Takes: the tree, and the text of declarations that could not be parsed. Gives: occurrences in the
// order of the text. Keeps true: names share one scope, so equal names mean the same; a word that
// is not a name in its place (a unit, a method, the name of an argument) is no occurrence.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ast/ast.hpp"
#include "check/context/scope.hpp"
#include "parse/words.hpp"
#include "source/source.hpp"

namespace etlc::lsp {

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

}  // namespace etlc::lsp
