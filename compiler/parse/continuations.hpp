// What may stand at a place of a spec, for completion.
// Takes: a text, and a place in it; what follows does not count. Gives: the words of the language
// that the grammar takes there, and what a name would name. Keeps true: it is the parser that
// compiles specs which is asked, a word at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "source/source.hpp"

namespace etlc::parse {

/// What a name is at a place.
enum class Role : std::uint8_t {
    none,     ///< no name stands there, or one that is declared there
    operand,  ///< of a formula or an expression
    point,    ///< an embedding, or a projection
    scalar,   ///< one of a vector [x, y]
    target,   ///< of a distance
    weights,  ///< of mahalanobis
    amount,   ///< a constant
    bound,    ///< a constant that is a bound of an interval
    encoder,
    predicate,             ///< whose truth it is
    calibration,           ///< a method of calibrated(...)
    fitting,               ///< a method of fitted(...)
    calibration_argument,  ///< the word before its '='
    fitting_argument,      ///< the same; `of` and `where` are words of the language
};

struct Continuations {
    /// The part of a word before the place, which is typed already.
    source::Span typed;
    std::vector<std::string> words;  ///< of the language, each in every spelling
    Role role = Role::none;
    bool number = false;        ///< one may stand there
    bool in_interval = false;   ///< and is a bound
    std::uint32_t begin = 0;    ///< of the declaration; the place, where none has begun
    std::string declaration;    ///< the word that began this declaration, "let"; empty: none has
    std::string number_before;  ///< the number before the place, of which a unit may follow
};

/// `offset` lies in the text. In a comment or a string nothing may stand.
Continuations continuations_at(const source::File& file, std::uint32_t offset);

}  // namespace etlc::parse
