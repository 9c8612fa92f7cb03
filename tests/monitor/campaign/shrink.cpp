#include "shrink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

#include "check/model/model.hpp"
#include "loading.hpp"

namespace etlc::tests {
namespace {

using check::Formula;
using check::Index;
using check::kUnbounded;
using Kind = Formula::Kind;

/// A formula as a separate tree, whose parts can be exchanged.
struct Tree {
    Kind kind = Kind::constant_true;
    Index number = 0;  ///< of a count
    bool each_step = false;
    std::string atom;
    std::uint32_t low = 0;
    std::uint32_t high = kUnbounded;
    std::vector<Tree> operands;
};

Tree tree_of(const check::Model& model, Index index) {
    const Formula& formula = model.formulas[index];
    Tree tree{.kind = formula.kind,
              .number = formula.index,
              .each_step = formula.each_step,
              .low = formula.low,
              .high = formula.high};
    if (formula.operands.empty()) tree.atom = "(" + check::print(model, index) + ")";
    if (formula.operands.empty() && formula.kind == Kind::predicate &&
        !model.predicates[formula.index].name.empty())
        tree.atom = model.predicates[formula.index].name;
    for (const Index operand : formula.operands) tree.operands.push_back(tree_of(model, operand));
    return tree;
}

const char* symbol(Kind kind) {
    switch (kind) {
        case Kind::negation: return "!";
        case Kind::conjunction: return "&&";
        case Kind::disjunction: return "||";
        case Kind::implication: return "->";
        case Kind::equivalence: return "<->";
        case Kind::next: return "X";
        case Kind::eventually: return "F";
        case Kind::always: return "G";
        case Kind::until: return "U";
        case Kind::weak_until: return "W";
        case Kind::release: return "R";
        case Kind::previous: return "Y";
        case Kind::once: return "O";
        case Kind::historically: return "H";
        case Kind::since: return "S";
        case Kind::rise: return "rise";
        case Kind::fall: return "fall";
        case Kind::held: return "held";
        default: return "";
    }
}

bool has_interval(Kind kind) {
    switch (kind) {
        case Kind::eventually:
        case Kind::always:
        case Kind::until:
        case Kind::release:
        case Kind::once:
        case Kind::historically:
        case Kind::since:
        case Kind::count:
        case Kind::held: return true;
        default: return false;
    }
}

std::string interval_text(const Tree& tree) {
    if (tree.kind == Kind::held) return fmt::format("[{}]", tree.high);
    if (!has_interval(tree.kind) || (tree.low == 0 && tree.high == kUnbounded)) return "";
    return tree.high == kUnbounded ? fmt::format("[{}, inf]", tree.low)
                                   : fmt::format("[{}, {}]", tree.low, tree.high);
}

std::string text(const Tree& tree) {
    if (tree.operands.empty()) return tree.atom;
    if (tree.kind == Kind::count && tree.each_step)
        return fmt::format("fraction({}, {} steps) >= {}", text(tree.operands[0]), tree.high + 1,
                           check::share_text(std::min(tree.number, tree.high + 1), tree.high + 1));
    if (tree.kind == Kind::count)
        return fmt::format("count({}, {} steps) >= {}", text(tree.operands[0]), tree.high + 1,
                           tree.number);
    const std::string word = symbol(tree.kind) + interval_text(tree);
    if (tree.operands.size() == 1) return word + " (" + text(tree.operands[0]) + ")";
    std::string result = "(" + text(tree.operands[0]) + ")";
    for (std::size_t i = 1; i < tree.operands.size(); ++i)
        result += " " + word + " (" + text(tree.operands[i]) + ")";
    return result;
}

/// Returns every tree that is one step smaller: a part in place of the whole, a shorter window.
std::vector<Tree> smaller(const Tree& tree) {
    std::vector<Tree> result = tree.operands;
    for (std::size_t i = 0; i < tree.operands.size(); ++i) {
        if (tree.operands.size() > 2) {
            result.push_back(tree);
            result.back().operands.erase(result.back().operands.begin() +
                                         static_cast<std::ptrdiff_t>(i));
        }
        for (Tree& operand : smaller(tree.operands[i])) {
            result.push_back(tree);
            result.back().operands[i] = std::move(operand);
        }
    }
    const auto with_interval = [&](std::uint32_t low, std::uint32_t high) {
        result.push_back(tree);
        result.back().low = low;
        result.back().high = high;
    };
    if (!has_interval(tree.kind)) return result;
    if (tree.low > 0) {
        with_interval(0, tree.high);
        with_interval(tree.low / 2, tree.high);
        with_interval(tree.low - 1, tree.high);
    }
    if (tree.high != kUnbounded && tree.high > tree.low) {
        with_interval(tree.low, tree.low + (tree.high - tree.low) / 2);
        with_interval(tree.low, tree.high - 1);
        if (tree.low > 0) with_interval(tree.low - 1, tree.high - 1);
    }
    return result;
}

/// The declarations of a spec, one per line, without lets and monitors.
std::string declarations(const std::string& spec) {
    std::istringstream lines(spec);
    std::string result;
    for (std::string line; std::getline(lines, line);) {
        const auto starts = [&](const char* word) { return line.rfind(word, 0) == 0; };
        if (starts("spec ") || starts("input ") || starts("target ") || starts("predicate "))
            result += line + '\n';
    }
    return result;
}

bool mentions(const std::string& text, const std::string& name) {
    const auto part_of_name = [&](std::size_t at) {
        return at < text.size() &&
               (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_');
    };
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
        if (!part_of_name(at + name.size()) && (at == 0 || !part_of_name(at - 1))) return true;
    return false;
}

/// Removes predicates and targets that nothing after them names. Inputs stay, because the trace has
/// their columns.
std::string used_only(const std::string& spec) {
    std::vector<std::string> lines;
    std::istringstream stream(spec);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    std::string kept;
    for (std::size_t n = lines.size(); n-- > 0;) {
        std::istringstream words(lines[n]);
        std::string kind;
        std::string name;
        words >> kind >> name;
        if ((kind == "predicate" || kind == "target") && !mentions(kept, name)) continue;
        kept = lines[n] + '\n' + kept;
    }
    return kept;
}

std::string kind_of(const check::Monitor& monitor) {
    if (monitor.sliding) return "sliding ";
    switch (monitor.restarts) {
        case check::Restarts::never: break;
        case check::Restarts::on_request: return "restartable ";
        case check::Restarts::when_final: return "repeating ";
    }
    return "";
}

class Shrinking {
public:
    Shrinking(Finding finding, const Trial& trial, int tries)
        : best_(std::move(finding)), trial_(trial), tries_(tries) {}

    Finding shrink() {
        const auto model = load(best_.spec);
        if (!model) return best_;
        declarations_ = declarations(best_.spec);
        for (const check::Monitor& monitor : model->monitors) {
            tree_ = tree_of(*model, monitor.formula);
            kind_ = kind_of(monitor);
            if (accepts(tree_, best_.trace)) break;
        }
        for (bool progress = true; progress && tries_ > 0;) {
            progress = shrink_trace();
            progress |= shrink_formula();
        }
        return best_;
    }

private:
    std::string spec_of(const Tree& tree) const {
        return used_only(declarations_ + fmt::format("{}monitor m = {};\n", kind_, text(tree)));
    }

    bool accepts(const Tree& tree, const reference::Trace& trace) {
        if (tries_-- <= 0) return false;
        const std::string spec = spec_of(tree);
        const auto mismatch = trial_(spec, trace);
        if (!mismatch) return false;
        best_ = {spec, trace, *mismatch};
        tree_ = tree;
        return true;
    }

    bool shrink_formula() {
        for (const Tree& candidate : smaller(tree_))
            if (accepts(candidate, best_.trace)) return true;
        return false;
    }

    /// Drops runs of steps, long ones first.
    bool shrink_trace() {
        bool progress = false;
        for (std::size_t run = best_.trace.size() / 2; run > 0; run /= 2)
            for (std::size_t at = 0; at + run <= best_.trace.size() && best_.trace.size() > run;) {
                reference::Trace shorter = best_.trace;
                const auto from = shorter.begin() + static_cast<std::ptrdiff_t>(at);
                shorter.erase(from, from + static_cast<std::ptrdiff_t>(run));
                if (accepts(tree_, shorter))
                    progress = true;
                else
                    at += run;
            }
        return progress;
    }

    Finding best_;
    const Trial& trial_;
    int tries_;
    std::string declarations_;
    Tree tree_;
    std::string kind_;  ///< "sliding ", "repeating " and so on
};

}  // namespace

Finding shrink(const Finding& finding, const Trial& trial, int tries) {
    return Shrinking(finding, trial, tries).shrink();
}

}  // namespace etlc::tests
