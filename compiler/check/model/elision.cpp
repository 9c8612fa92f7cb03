#include "check/model/elision.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "source/text.hpp"

namespace etlc::check {

namespace {

constexpr std::string_view kLeftOut = "...";

/// Shortens a long word in the middle, between code points.
std::string middle_left_out(const std::string& word, std::size_t most) {
    const auto inside = [&](std::size_t i) { return source::is_continuation(word[i]); };
    const std::size_t kept = most - kLeftOut.size();
    std::size_t head = (kept + 1) / 2;
    std::size_t tail = word.size() - kept / 2;
    while (head > 0 && inside(head)) --head;
    while (tail < word.size() && inside(tail)) ++tail;
    return word.substr(0, head).append(kLeftOut).append(word, tail);
}

class Writer {
public:
    explicit Writer(const PhraseOf& phrase_of) : phrase_of_(phrase_of) {}

    /// Returns nothing if the text would be longer.
    std::optional<std::string> whole(Phrase::Operand operand, std::size_t most) const {
        std::string text;
        if (!append(operand, most, text)) return std::nullopt;
        return text;
    }

    /// Returns at most `most` characters, or "..." if there is too little room.
    std::string elided(Phrase::Operand operand, std::size_t most) const {
        if (auto text = whole(operand, most)) return *std::move(text);
        const Phrase phrase = phrase_of_(operand.formula);
        const std::size_t around =
            phrase.opening.size() + phrase.closing.size() + (operand.brackets ? 2 : 0);
        std::string inside;
        if (phrase.operands.empty()) {
            if (most < around - phrase.opening.size() + 2 * kLeftOut.size())
                return std::string(kLeftOut);
            inside = middle_left_out(phrase.opening, most - (around - phrase.opening.size()));
        } else {
            const std::size_t gaps =
                phrase.separator.size() * std::min<std::size_t>(phrase.operands.size() - 1, 2);
            const std::size_t least =
                around + gaps + kLeftOut.size() * std::min<std::size_t>(phrase.operands.size(), 3);
            if (most < least) return std::string(kLeftOut);
            inside = phrase.opening + chain(phrase, most - around) + phrase.closing;
        }
        return operand.brackets ? '(' + inside + ')' : inside;
    }

private:
    /// Returns false as soon as the text is too long. Each level adds at least one character.
    bool append(Phrase::Operand operand, std::size_t most, std::string& text,
                std::size_t depth = 0) const {
        if (depth > most) return false;
        const Phrase phrase = phrase_of_(operand.formula);
        if (operand.brackets) text += '(';
        text += phrase.opening;
        for (std::size_t i = 0; i < phrase.operands.size(); ++i) {
            if (i > 0) text += phrase.separator;
            if (text.size() > most || !append(phrase.operands[i], most, text, depth + 1))
                return false;
        }
        text += phrase.closing;
        if (operand.brackets) text += ')';
        return text.size() <= most;
    }

    /// Joins the operands, leaving out those in the middle if there are more than two.
    std::string chain(const Phrase& phrase, std::size_t most) const {
        const std::vector<Phrase::Operand>& operands = phrase.operands;
        const std::string& separator = phrase.separator;
        if (operands.size() == 1) return elided(operands[0], most);
        std::size_t room = most - separator.size();
        if (operands.size() > 2) room -= kLeftOut.size() + separator.size();
        auto [head, tail] = two(operands.front(), operands.back(), room);
        room -= head.size() + tail.size();
        std::size_t next = 1;
        std::size_t last = operands.size() - 1;
        for (bool ahead = true; next < last && room >= separator.size();
             ahead = !ahead) {  // complete operands between
            const auto more = whole(operands[ahead ? next : last - 1], room - separator.size());
            if (!more) break;
            room -= more->size() + separator.size();
            ahead ? head.append(separator).append(*more) : tail.insert(0, *more + separator);
            ahead ? ++next : --last;
        }
        if (next < last) head.append(separator).append(kLeftOut);
        return head + separator + tail;
    }

    /// Gives each half of the room, and the other what one leaves.
    std::pair<std::string, std::string> two(Phrase::Operand left, Phrase::Operand right,
                                            std::size_t room) const {
        if (const auto first = whole(left, room / 2))
            return {*first, elided(right, room - first->size())};
        if (const auto second = whole(right, room / 2))
            return {elided(left, room - second->size()), *second};
        return {elided(left, room / 2), elided(right, room / 2)};
    }

    const PhraseOf& phrase_of_;
};

}  // namespace

std::string whole_text(Index root, const PhraseOf& phrase_of) {
    return *Writer(phrase_of).whole({root}, std::numeric_limits<std::size_t>::max());
}

std::string short_text(Index root, const PhraseOf& phrase_of, std::size_t most) {
    return Writer(phrase_of).whole({root}, most).value_or("");
}

std::string elided_text(Index root, const PhraseOf& phrase_of, std::size_t most) {
    return Writer(phrase_of).elided({root}, most);
}

}  // namespace etlc::check
