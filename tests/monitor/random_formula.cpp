#include "random_formula.hpp"

#include <fmt/format.h>

#include <utility>

namespace etlc::tests {

std::string RandomFormula::inside(const Piece& piece, Level outer) {
    const bool needed = piece.level <= outer && !(outer == prefix && piece.level == prefix);
    return needed || random_.chance(0.1) ? "(" + piece.text + ")" : piece.text;
}

RandomFormula::Piece RandomFormula::unary(const std::string& word, const std::string& interval,
                                          const Piece& operand) {
    return {word + interval + " " + inside(operand, prefix), prefix};
}

RandomFormula::Piece RandomFormula::binary(const Piece& left, const std::string& word,
                                           const std::string& interval, const Piece& right,
                                           Level level) {
    return {inside(left, level) + " " + word + interval + " " + inside(right, level), level};
}

std::string RandomFormula::bounded_interval() {
    const int high = random_.between(0, shape_.window);
    return fmt::format("[{}, {}]", random_.between(0, high), high);
}

std::string RandomFormula::future_interval() {
    if (shape_.bounded && (!shape_.unbounded || random_.chance(0.6))) return bounded_interval();
    return random_.chance(0.7) ? "" : random_.chance(0.5) ? "[1, inf]" : "[2, inf]";
}

std::string RandomFormula::past_interval() {
    if (random_.chance(0.5)) return bounded_interval();
    return random_.chance(0.6) ? "" : "[1, inf]";
}

RandomFormula::Piece RandomFormula::leaf() {
    if (random_.chance(0.04)) return {random_.word({"true", "false"}), atom};
    if (random_.chance(0.12)) return {"(" + comparison_() + ")", atom};
    return {random_.pick(atoms_), atom};
}

RandomFormula::Piece RandomFormula::connective(int depth, Allowed allowed) {
    const auto operand = [&] { return grow(depth - 1, allowed); };
    const Piece left = operand();
    switch (random_.between(0, 9)) {
        case 0:
        case 1:
        case 2: return binary(left, random_.word({"&&", "and"}), "", operand(), conjunction);
        case 3:
        case 4:
        case 5: return binary(left, random_.word({"||", "or"}), "", operand(), disjunction);
        case 6: return binary(left, random_.word({"->", "implies"}), "", operand(), implies);
        case 7: return binary(left, random_.word({"<->", "iff"}), "", operand(), iff);
        default: return unary(random_.word({"!", "not"}), "", left);
    }
}

RandomFormula::Piece RandomFormula::future(int depth, Allowed allowed) {
    if (!shape_.nested) allowed = {false, false};
    if (shape_.nested && shape_.bounded && depth >= 2 && random_.chance(0.08))
        return response_in_two(depth, allowed);
    const Piece operand = grow(depth - 1, allowed);
    switch (random_.between(0, 7)) {
        case 0:
        case 1: return unary(random_.word({"F", "eventually"}), future_interval(), operand);
        case 2:
        case 3: return unary(random_.word({"G", "always"}), future_interval(), operand);
        case 4:
            return binary(operand, random_.word({"U", "until"}), future_interval(),
                          grow(depth - 1, allowed), until);
        case 5:
            return binary(operand, random_.word({"R", "release"}), future_interval(),
                          grow(depth - 1, allowed), until);
        case 6:
            if (shape_.unbounded)
                return binary(operand, random_.word({"W", "weak_until"}), "",
                              grow(depth - 1, allowed), until);
            [[fallthrough]];
        default: return unary(random_.word({"X", "next"}), "", operand);
    }
}

/// G (f || F[a,b] (g && F[c,d] h)) or its dual, sometimes without f, or with an until inside:
/// random growth rarely gives this shape.
RandomFormula::Piece RandomFormula::response_in_two(int depth, Allowed allowed) {
    const bool always = random_.chance(0.5);
    const auto operand = [&] { return grow(depth - 3, {false, allowed.past}); };
    const auto either = [&](bool max, const Piece& a, const Piece& b) {
        return max ? binary(a, "||", "", b, disjunction) : binary(a, "&&", "", b, conjunction);
    };
    const std::string seek = always ? "F" : "G";
    const Piece last = operand();
    const Piece completed = random_.chance(0.25) ? binary(operand(), always ? "U" : "R",
                                                          bounded_interval(), last, until)
                                                 : unary(seek, bounded_interval(), last);
    Piece body = unary(seek, bounded_interval(), either(!always, operand(), completed));
    if (random_.chance(0.7)) body = either(always, operand(), body);
    return unary(always ? "G" : "F", future_interval(), body);
}

/// In the dual of a chain: F (p && F (q && ...)).
RandomFormula::Piece RandomFormula::early(int phases, bool max) {
    const std::string word = max ? "G" : "F";
    const std::string interval = random_.word({"", "", "", "[1, inf]", "[2, inf]"});
    const Piece present = grow(random_.between(0, 1), {false, true});
    if (phases <= 0) return unary(word, interval, present);
    const Piece rest = early(phases - 1, max);
    return unary(word, interval,
                 max ? binary(present, "||", "", rest, disjunction)
                     : binary(present, "&&", "", rest, conjunction));
}

/// In the dual of a chain: an U that, until its right side holds, holds at the next step too.
RandomFormula::Piece RandomFormula::late(int phases, bool max) {
    const Piece present = grow(random_.between(0, 1), {false, true});
    const std::string wait = max ? "R" : "U";
    if (phases <= 0) return binary(grow(0, {false, true}), wait, "", present, until);
    switch (random_.between(0, 4)) {
        case 0: return binary(present, wait, "", late(phases - 1, max), until);
        case 1: return unary(max ? "G" : "F", "", late(phases - 1, max));
        default: return binary(chain(phases - 1, max), wait, "", present, until);
    }
}

/// One thing after the other, each in the time of the one before: F[a,b] (p && F[c,d] q).
RandomFormula::Piece RandomFormula::sequence(int phases, bool max) {
    const auto present = [&] { return grow(random_.between(0, 1), {false, true}); };
    const auto join = [&](const Piece& a, const Piece& b, bool is_or) {
        return is_or ? binary(a, "||", "", b, disjunction) : binary(a, "&&", "", b, conjunction);
    };
    Piece body = present();
    if (phases > 0) {
        const Piece rest = sequence(phases - 1, max);
        const int kind = random_.between(0, 9);
        body = kind == 0   ? rest
               : kind == 1 ? join(body, join(present(), rest, max), !max)
               : kind == 2 ? join(rest, sequence(0, max), max)
                           : join(body, rest, !max);
    }
    const std::string interval = random_.chance(0.8) ? bounded_interval() : future_interval();
    if (random_.chance(0.25)) return binary(present(), max ? "U" : "R", interval, body, until);
    return unary(max ? "F" : "G", interval, body);
}

/// Formulas that wait for one thing after the other: in each && at most one side looks ahead, the
/// left side of U does not, and the right one of R only in W or where its ways never compete. The
/// dual exchanges the operators.
RandomFormula::Piece RandomFormula::chain(int phases, bool max) {
    const Piece present = grow(random_.between(0, 2), {false, true});
    if (phases == 0) return present;
    const auto either = [&](const Piece& a, const Piece& b, bool is_or) {
        return is_or ? binary(a, "||", "", b, disjunction) : binary(a, "&&", "", b, conjunction);
    };
    const auto interval = [&] {
        return random_.word({"", "", "", "", "", "[1, inf]", "[1, inf]", "[2, inf]"});
    };
    const std::string seek = max ? "F" : "G";
    const std::string hold = max ? "G" : "F";
    const Piece rest = chain(phases - 1, max);
    const std::string next = max ? "X" : "!X !";  // of a chain it is a step of the same chain
    switch (random_.between(0, 15)) {
        case 13: return unary(hold, interval(), either(present, early(phases - 1, max), max));
        case 14:
            return binary(rest, max ? "R" : "U", interval(),
                          either(present, early(phases - 1, max), max), until);
        case 15: return binary(present, max ? "R" : "U", interval(), late(phases - 1, max), until);
        case 0:
        case 1:
        case 2:
        case 3: return unary(seek, interval(), either(present, rest, !max));
        case 4: return unary(seek, interval(), either(present, unary(next, "", rest), !max));
        case 5:
        case 6: return binary(present, max ? "U" : "R", interval(), rest, until);
        case 7: return binary(present, max ? "U" : "R", "", either(present, rest, !max), until);
        case 8: return binary(rest, max ? "R" : "U", interval(), present, until);
        case 9:
            return max ? binary(present, "W", "", rest, until)
                       : unary(seek, interval(), either(present, rest, !max));
        case 10: return either(unary(hold, interval(), present), rest, max);
        case 11: return either(present, rest, random_.chance(0.5));
        default: return unary(seek, random_.word({"[1, 1]", "[3, 3]"}), rest);
    }
}

RandomFormula::Piece RandomFormula::past(int depth, Allowed allowed) {
    if (!shape_.nested) allowed = {false, false};
    if (!shape_.past_over_future) allowed.future = false;
    const Piece operand = grow(depth - 1, allowed);
    switch (random_.between(0, 8)) {
        case 0:
        case 1: return unary(random_.word({"O", "once"}), past_interval(), operand);
        case 2: return unary(random_.word({"H", "historically"}), past_interval(), operand);
        case 3:
        case 4:
            return binary(operand, random_.word({"S", "since"}), past_interval(),
                          grow(depth - 1, allowed), until);
        case 5: return unary(random_.word({"rise", "fall"}), "", operand);
        case 6: return count(operand);
        case 7: return unary("held", fmt::format("[{}]", random_.between(0, 4)), operand);
        default: return unary(random_.word({"Y", "previous"}), "", operand);
    }
}

/// A comparison of a count or a fraction that is neither always true nor always false.
RandomFormula::Piece RandomFormula::count(const Piece& operand) {
    const int steps = random_.between(1, 8);
    if (random_.chance(0.5)) {
        const std::string fraction = fmt::format("fraction({}, {} steps)", operand.text, steps);
        const std::string share = fmt::format("{}.{}", 0, random_.between(1, 99));
        switch (random_.between(0, 4)) {
            case 0: return {fmt::format("{} > {}", fraction, share), atom};
            case 1: return {fmt::format("{} < {}", fraction, share), atom};
            case 2: return {fmt::format("{} >= {}", share, fraction), atom};
            case 3: return {fmt::format("{} >= 1", fraction), atom};
            default: return {fmt::format("{} >= {}", fraction, share), atom};
        }
    }
    const int most = (steps + 1) / 2;
    const std::string counted = fmt::format("count({}, {} steps)", operand.text, steps);
    const int n = random_.between(1, most);
    switch (random_.between(0, 5)) {
        case 0: return {fmt::format("{} > {}", counted, n - 1), atom};
        case 1: return {fmt::format("{} < {}", counted, n), atom};
        case 2: return {fmt::format("{} >= {}", n - 1, counted), atom};
        case 3: return {fmt::format("{} == {}", counted, random_.between(0, most)), atom};
        case 4: return {fmt::format("{} != {}", counted, n), atom};
        default: return {fmt::format("{} >= {}", counted, n), atom};
    }
}

RandomFormula::Piece RandomFormula::named(Piece piece) {
    const std::string name = fmt::format("{}{}", let_name_, let_count_++);
    lets_ += fmt::format("let {} = {};\n", name, piece.text);
    return {name, atom};
}

RandomFormula::Piece RandomFormula::grow(int depth, Allowed allowed) {
    if (depth <= 0 || random_.chance(0.08)) return leaf();
    const double die = random_.uniform();
    const double past_or_future = shape_.future + 0.3 * (1 - shape_.future);
    Piece piece = allowed.future && die < shape_.future  ? future(depth, allowed)
                  : allowed.past && die < past_or_future ? past(depth, allowed)
                                                         : connective(depth, allowed);
    return random_.chance(0.07) ? named(std::move(piece)) : piece;
}

}  // namespace etlc::tests
