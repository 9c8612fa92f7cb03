// What people write who know other languages of temporal logic, mathematics or programming.
// Takes: a word, or the place at which the parser is stuck. Gives: what is written here in its
// place. Keeps true: nothing is guessed from a likeness of letters; that is diag::nearest_name.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "parse/stream/stuck.hpp"

namespace etlc::parse {

/// What a foreign word stands for.
enum class Foreign : std::uint8_t { prefix, infix, unit, type, declaration, callable };

struct Native {
    std::string word;  ///< to be written in its place; empty: there is no one word
    std::string note;  ///< in words
};

/// Nothing where the word is not known.
std::optional<Native> native(Foreign kind, std::string_view word);

/// The words of the language of that kind, operators aside.
std::vector<std::string> own_words(Foreign kind);

/// Whether `list`, words with a blank between them, has the word.
bool is_listed(std::string_view list, std::string_view word);

/// An operator of another language: the whole error.
std::optional<diag::Diagnostic> foreign_operator(const Stuck& stuck, const Token& found,
                                                 const source::File& file);

/// Adds to an error how the form that was meant is written; nothing where none is known.
void add_note_on_foreign_form(const Stuck& stuck, const Token& found, const source::File& file,
                              diag::Diagnostic& to);

/// What to say of a token for which is_mistake() holds, and of what it stands behind (null: of
/// nothing); nothing where its bytes are not UTF-8, which has been said of the file as a whole.
std::optional<diag::Diagnostic> explain_mistake(const Token& token, const Token* previous,
                                                const source::File& file);

}  // namespace etlc::parse
