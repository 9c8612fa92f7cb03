// Where the names of a spec stand: the one declaration of each, and its uses.
// Takes: the tree, and the text for what could not be read. Gives: occurrences in the order of the
// text. Keeps true: all names share one set, so equal names mean the same; a word that is no name
// where it stands (a unit, a method, the name of an argument) is no occurrence.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ast/ast.hpp"
#include "check/context/scope.hpp"
#include "source/source.hpp"

namespace etlc::lsp {

struct Occurrence {
    std::string name;
    source::Span span;
    bool declares = false;
    /// In quotes: the key of frames(...), which recordings have as well.
    bool quoted = false;
    /// In a declaration that could not be read, so that it may be something else.
    bool uncertain = false;
    bool of_spec = false;  ///< the spec's own name, which is not one of the set

    bool means_the_same(const Occurrence& other) const {
        return name == other.name && of_spec == other.of_spec;
    }
};

/// What kind of samples an input has, as far as its words tell.
enum class Shape : std::uint8_t { embedding, scalar, boolean };

struct Declared {
    std::string name;
    /// Nothing: the spec itself.
    std::optional<check::NameKind> kind;
    source::Span name_span;
    source::Span span;  ///< of the whole declaration
    Shape shape = Shape::scalar;
    bool is_duration = false;  ///< a constant with a unit
};

/// A file that the spec names, where it names it.
struct NamedFile {
    std::string path;
    source::Span span;
};

struct Names {
    std::vector<Declared> declared;  ///< in the order of the text
    std::vector<Occurrence> occurrences;
    std::vector<NamedFile> files;
    /// The declarations that could be read.
    std::vector<source::Span> readable;
};

Names names_of(const ast::Spec& spec, const source::File& file);

/// Adds the words of declarations that could not be read and have the name of something. Takes the
/// time of reading all words.
void add_uncertain(Names& names, const source::File& file);

/// The one whose span `offset` lies in or behind; null: none.
const Occurrence* occurrence_at(const Names& names, std::uint32_t offset);
/// What it means: the first declaration of its name; null: there is none.
const Declared* declaration_of(const Names& names, const Occurrence& occurrence);

}  // namespace etlc::lsp
