// What people write who know other languages of temporal logic, mathematics or programming.
// Takes: a word, or the place at which the parser is stuck. Gives: what is written here in its
// place. Keeps true: nothing is guessed from a likeness of letters; that is diag::nearest_name.
#pragma once

#include <optional>
#include <string>
#include <string_view>

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

/// Whether an operand, or an interval, ends with this token; null: there is none.
bool ends_operand(const Token* token);

/// An operator of another language: the whole error.
std::optional<diag::Diagnostic> foreign_operator(const Stuck& stuck, const Token& found,
                                                 const source::File& file);

/// Adds to an error how the form that was meant is written; nothing where none is known.
void add_note_on_foreign_form(const Stuck& stuck, const Token& found, const source::File& file,
                              diag::Diagnostic& to);

}  // namespace etlc::parse
