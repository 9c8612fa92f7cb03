// Completion: what may follow at a place in a spec. Lists the words that the grammar accepts there,
// and what a name would stand for. Text after the place is ignored. The parser that compiles specs
// is asked, one word at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "source/source.hpp"

namespace etlc::parse {

/// The meaning of a name at a place.
enum class Role : std::uint8_t {
    none,     ///< no name fits, or one that is being declared
    operand,  ///< in a formula or an expression
    point,    ///< an embedding or a projection
    scalar,   ///< in a vector [x, y]
    target,   ///< of a distance
    weights,  ///< of mahalanobis
    amount,   ///< a constant
    bound,    ///< a constant that is a bound of an interval
    encoder,
    predicate,             ///< in a truth
    watched,               ///< by a drift: a predicate or a monitor
    calibration,           ///< a method of calibrated(...)
    fitting,               ///< a method of fitted(...)
    calibration_argument,  ///< the word before '='
    drift_argument,        ///< the word before '='
    fitting_argument,      ///< the word before '='; `of` and `where` are words of the language
};

struct Continuations {
    /// The part of a word before the place that has already been typed.
    source::Span typed;
    std::vector<std::string> words;  ///< of the language, in every spelling
    Role role = Role::none;
    bool number = false;        ///< a number fits
    bool in_interval = false;   ///< and is a bound
    std::uint32_t begin = 0;    ///< of the declaration; the place itself if none has begun
    std::string declaration;    ///< first word of this declaration, "let"; empty if none has begun
    std::string number_before;  ///< the number before the place, which a unit may follow
};

/// `offset` lies within the text. Nothing may follow in a comment or a string.
Continuations continuations_at(const source::File& file, std::uint32_t offset);

}  // namespace etlc::parse
