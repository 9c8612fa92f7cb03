// Explains words and forms that people know from other languages of temporal logic, mathematics or
// programming. Nothing is guessed from similar spelling; diag::nearest_name does that.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "parse/stream/stuck.hpp"

namespace etlc::parse {

/// The kind of word that a foreign word replaces.
enum class Foreign : std::uint8_t { prefix, infix, unit, type, declaration, callable };

struct Native {
    std::string word;  ///< replacement; empty if no single word replaces it
    std::string note;  ///< the explanation
};

/// Returns nothing for an unknown word.
std::optional<Native> native(Foreign kind, std::string_view word);

/// Returns the words of this language of one kind, without operators.
std::vector<std::string> own_words(Foreign kind);

/// Whether `list`, words separated by blanks, contains `word`.
bool is_listed(std::string_view list, std::string_view word);

/// Returns the error for an operator of another language.
std::optional<diag::Diagnostic> foreign_operator(const Stuck& stuck, const Token& found,
                                                 const source::File& file);

/// Adds a note on how a recognised foreign form is written in this language.
void add_note_on_foreign_form(const Stuck& stuck, const Token& found, const source::File& file,
                              diag::Diagnostic& to);

/// Explains a token for which is_mistake() holds. `previous` is null if there is none. Returns
/// nothing for bytes that are not UTF-8, which are reported for the whole file.
std::optional<diag::Diagnostic> explain_mistake(const Token& token, const Token* previous,
                                                const source::File& file);

}  // namespace etlc::parse
