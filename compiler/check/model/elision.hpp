// Prints formulas for people, with parts of long ones left out: "..." replaces operands in the
// middle of a chain, deep operands, or the middle of a long name. Brackets are paired. The work
// depends on the limit and not on the formula, which shares parts and may be exponentially long as
// a tree.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

/// The opening, the operands with separators, and the closing; an atom is only an opening.
struct Phrase {
    struct Operand {
        Index formula = 0;
        bool brackets = false;
    };
    std::string opening;
    std::vector<Operand> operands{};
    std::string separator{};
    std::string closing{};
};
using PhraseOf = std::function<Phrase(Index formula)>;

inline constexpr std::size_t kMostShown = 200;

/// Returns the complete text.
std::string whole_text(Index root, const PhraseOf& phrase_of);
/// Returns the complete text if it has at most `most` characters, otherwise nothing.
std::string short_text(Index root, const PhraseOf& phrase_of, std::size_t most = kMostShown);
/// Returns the text with parts left out, for messages, comments and reports.
std::string elided_text(Index root, const PhraseOf& phrase_of, std::size_t most = kMostShown);

}  // namespace etlc::check
