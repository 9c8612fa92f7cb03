#include "emit/text/identifiers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>
#include <vector>

#include "check/names/reserved.hpp"

namespace etlc::emit {

namespace {

/// Returns the word for a symbol of formulas and expressions.
std::string_view word_for(char symbol) {
    switch (symbol) {
        case '!': return "not";
        case '&': return "and";
        case '|': return "or";
        case '<': return "below";
        case '>': return "above";
        case '+': return "plus";
        case '-': return "minus";
        case '*': return "times";
        case '/': return "over";
        default: return "";
    }
}

std::string_view word_for_operator(std::string_view letter) {
    if (letter == "F") return "eventually";
    if (letter == "G") return "always";
    if (letter == "U") return "until";
    if (letter == "R") return "release";
    if (letter == "O") return "once";
    if (letter == "H") return "historically";
    if (letter == "S") return "since";
    if (letter == "X") return "next";
    if (letter == "Y") return "previous";
    return letter;
}

void append_word(std::string& name, std::string_view word) {
    if (word.empty()) return;
    if (!name.empty()) name += '_';
    name += word;
}

/// Returns a temporal operator without its operands: "F[0, 3]", "O". T is not a word of the
/// language, and may be a name of the spec.
std::string head_of(const ir::Node& node) {
    const std::string letter = ir::info(node.op).symbol;
    const std::string symbol = letter == "T" ? "trigger" : letter;
    if (node.interval == ir::Interval{}) return symbol;
    if (!node.interval.bounded()) return fmt::format("{}[{}, inf]", symbol, node.interval.low);
    return fmt::format("{}[{}, {}]", symbol, node.interval.low, node.interval.high);
}

}  // namespace

std::string identifier(std::string_view text, const std::string& otherwise) {
    if (text.find("...") != std::string_view::npos) return otherwise;  // parts were left out
    std::string name;
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i;
        while (end < text.size() &&
               (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_'))
            ++end;
        if (end > i) {
            append_word(name, word_for_operator(text.substr(i, end - i)));
        } else if (text.substr(i, 2) == "==" || text.substr(i, 2) == "!=") {
            end = i + 2;
            append_word(name, text[i] == '=' ? "is" : "is_not");
        } else {
            end = i + 1;
            append_word(name, word_for(text[i]));
            while (end < text.size() && text[end] == text[i]) ++end;  // && and ||
        }
        i = end;
    }
    const bool legal = !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0 &&
                       name[0] != '_' && name.find("__") == std::string::npos &&
                       name.size() <= kLongestName;
    return legal ? name : otherwise;
}

std::string name_of(const check::Model& model, const check::Past& past) {
    const bool is_ago = past.kind == check::Past::Kind::ago;
    const std::string otherwise = is_ago ? fmt::format("value_{}_ago", past.steps)
                                         : fmt::format("{}_{}", word(past.kind), past.steps);
    if (model.retargetable) return otherwise;
    const std::string of = identifier(check::print(model, past.expression), "");
    if (of.empty()) return otherwise;
    return identifier(is_ago ? fmt::format("{}_{}_ago", of, past.steps)
                             : fmt::format("{}_{}_{}", word(past.kind), of, past.steps),
                      otherwise);
}

std::string with_more(const std::string& operand, bool max) {
    return operand + (max ? "_or_more" : "_and_more");
}

namespace {

/// Returns the shortest name among the first few operands, or else a shortened name of the first.
std::string name_of_one(const ir::Graph& graph, const std::vector<ir::NodeId>& operands,
                        std::size_t room) {
    constexpr std::size_t kFew = 8;
    std::string shortest;
    for (std::size_t i = 0; i < std::min(kFew, operands.size()); ++i) {
        const std::string words = identifier(graph.short_text(operands[i]), "");
        const bool shorter = shortest.empty() || words.size() < shortest.size();
        if (!words.empty() && words.size() <= room && shorter) shortest = words;
    }
    return shortest.empty() ? name_of(graph, operands[0], room) : shortest;
}

/// Returns "count_grasp_from_3", "count_grasp_below_3", or "fraction_near_from_40_of_50".
std::string name_of_count(const ir::Graph& graph, const ir::Node& node, std::size_t room) {
    const std::string head = node.counted.each_step ? "fraction" : "count";
    const std::string tail =
        fmt::format("_{}_{}{}", ir::takes_max(node.op) ? "from" : "below", node.index,
                    node.counted.each_step ? fmt::format("_of_{}", node.interval.high + 1) : "");
    if (head.size() + tail.size() + 1 >= room) return head;
    const std::string of =
        name_of(graph, node.counted.formula, room - head.size() - tail.size() - 1);
    return head + (of.empty() ? "" : '_' + of) + tail;
}

}  // namespace

std::string name_of(const ir::Graph& graph, ir::NodeId id, std::size_t room) {
    const std::string words = identifier(graph.short_text(id), "");
    if (!words.empty() && words.size() <= room) return words;
    const ir::Node& node = graph[id];
    if (node.operands.empty()) return "";
    if (ir::info(node.op).arity == ir::Arity::many) {
        const bool max = node.op == ir::Op::disjunction;
        const std::size_t more = with_more("", max).size();
        const std::string one = room > more ? name_of_one(graph, node.operands, room - more) : "";
        return one.empty() ? "" : with_more(one, max);
    }
    if (ir::counts(node.op)) return name_of_count(graph, node, room);
    const std::string head = identifier(head_of(node), "");
    if (head.size() > room) return "";
    const std::size_t left = room - head.size();
    const std::string of = left > 1 ? name_of(graph, node.operands.back(), left - 1) : "";
    return of.empty() ? head : head + '_' + of;
}

namespace {

bool in_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Returns the position after the string literal that begins at `at`.
std::size_t end_of_string(std::string_view code, std::size_t at) {
    for (++at; at < code.size() && code[at] != '"'; ++at)
        if (code[at] == '\\') ++at;
    return at + 1;
}

/// Returns the words outside strings and comments that may be macros elsewhere.
std::set<std::string> macros_in(std::string_view code) {
    std::set<std::string> found;
    for (std::size_t at = 0; at < code.size();) {
        if (code[at] == '"') {
            at = end_of_string(code, at);
        } else if (code.substr(at, 2) == "//") {
            at = std::min(code.find('\n', at), code.size());
        } else if (in_word(code[at])) {
            const std::size_t begin = at;
            while (at < code.size() && in_word(code[at])) ++at;
            const std::string_view word = code.substr(begin, at - begin);
            const bool is_capital =
                word.size() == 1 && std::isupper(static_cast<unsigned char>(word[0])) != 0;
            if (is_capital || check::macro_elsewhere(word)) found.emplace(word);
        } else {
            ++at;
        }
    }
    return found;
}

}  // namespace

std::string shielded(const std::string& code) {
    const std::set<std::string> names = macros_in(code);
    if (names.empty()) return code;
    std::string before = "// These names are macros in some headers: they are not macros here.\n";
    std::string after = "\n";
    for (const std::string& name : names) {
        before += fmt::format("#pragma push_macro(\"{0}\")\n#undef {0}\n", name);
        after += fmt::format("#pragma pop_macro(\"{}\")\n", name);
    }
    return before + "\n" + code + after;
}

std::string Scope::claim(const std::string& wanted, const std::string& mark) {
    std::string name = wanted + mark;
    for (int i = 2; !taken_.insert(name).second; ++i)
        name = fmt::format("{}_{}{}", wanted, i, mark);
    return name;
}

std::string Scope::number(const std::string& wanted) {
    int i = 1;
    while (!taken_.insert(fmt::format("{}_{}", wanted, i)).second) ++i;
    return fmt::format("{}_{}", wanted, i);
}

}  // namespace etlc::emit
