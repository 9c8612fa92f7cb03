// Formulas as text that people read: long ones with parts left out.
// Takes: what each formula's text is made of. Gives: the whole text where it has at most kMostShown
// characters, else one of at most so many, in which "..." stands for what is left out: operands in
// the middle of a chain, operands too deep, the middle of a long name. Keeps true: brackets are
// paired; the work depends on the limit and not on the formula, which shares parts and may be
// exponentially long as a tree.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

/// opening, the operands with separators between them, closing; an atom is an opening alone.
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

/// The text in full.
std::string whole_text(Index root, const PhraseOf& phrase_of);
/// The text in full where it has at most `most` characters, else nothing: for names, which want few
/// words or none.
std::string short_text(Index root, const PhraseOf& phrase_of, std::size_t most = kMostShown);
/// For messages, comments, reports.
std::string elided_text(Index root, const PhraseOf& phrase_of, std::size_t most = kMostShown);

}  // namespace etlc::check
