// Prints formulas and expressions as canonical text with symbols, and parentheses only where the
// grammar needs them.
#include <fmt/format.h>

#include <string_view>
#include <unordered_map>

#include "check/model/elision.hpp"
#include "check/model/model.hpp"
#include "check/numbers/decimal.hpp"

namespace etlc::check {

namespace {

using Kind = Formula::Kind;

class Phrases {
public:
    /// `let_names` replace formulas below the root.
    /// `has_results`: calibrated durations are shown as numbers.
    Phrases(const Model& model, Index root, bool has_results,
            std::unordered_map<Index, std::string> let_names = {})
        : model_(model), root_(root), has_results_(has_results), let_names_(std::move(let_names)) {}

    Phrase operator()(Index index) const {
        if (const auto* name = let_name(index)) return {.opening = *name};
        const Formula& formula = model_.formulas[index];
        const ast::Operator* const op = ast::operator_of(formula.kind);
        if (op == nullptr) return {.opening = atom(formula)};
        if (formula.kind == Kind::count) return count(formula, ">=");
        if (is_below(formula)) return count(model_.formulas[formula.operands[0]], "<");
        const std::string symbol = std::string(op->symbol) + interval(formula);
        Phrase phrase;
        if (op->level < ast::kPrefix)
            phrase.separator = ' ' + symbol + ' ';
        else
            phrase.opening = formula.kind == Kind::negation ? symbol : symbol + ' ';
        for (std::size_t i = 0; i < formula.operands.size(); ++i)
            phrase.operands.push_back(
                {formula.operands[i], level(formula.operands[i]) < weakest(op->level, i == 0)});
        return phrase;
    }

private:
    const std::string* let_name(Index index) const {
        const auto let = let_names_.find(index);
        return let != let_names_.end() && index != root_ ? &let->second : nullptr;
    }

    int level(Index index) const {
        const auto* const op = ast::operator_of(model_.formulas[index].kind);
        return op == nullptr || let_name(index) != nullptr ? ast::kAtom : op->level;
    }

    /// Returns the loosest operator that an operand may have without parentheses.
    static int weakest(ast::FormulaLevel level, bool first) {
        if (level == ast::kPrefix) return level;
        const bool left_associative = level == ast::kIff;
        const bool right_associative = level == ast::kImplies || level == ast::kBinary;
        const bool tighter = (right_associative && first) || (left_associative && !first);
        return level + (tighter ? 1 : 0);
    }

    Phrase count(const Formula& formula, std::string_view comparison) const {
        const std::string time =
            is_shown(formula) ? fmt::format("{} steps", formula.high + 1) : "calibrated";
        const std::string number = formula.each_step ? share_text(formula.index, formula.high + 1)
                                                     : std::to_string(formula.index);
        return {.opening = formula.each_step ? "fraction(" : "count(",
                .operands = {{formula.operands[0], false}},
                .closing = fmt::format(", {}) {} {}", time, comparison, number)};
    }

    bool is_shown(const Formula& formula) const {
        return formula.time == Formula::Time::written ||
               (formula.time == Formula::Time::calibrated && has_results_);
    }

    /// Whether it is the negation of a count, which `<` says.
    bool is_below(const Formula& formula) const {
        return formula.kind == Kind::negation && let_name(formula.operands[0]) == nullptr &&
               model_.formulas[formula.operands[0]].kind == Kind::count;
    }

    std::string atom(const Formula& formula) const {
        if (formula.kind == Kind::boolean_input) return model_.inputs[formula.index].name;
        if (formula.kind == Kind::predicate) return model_.predicates[formula.index].shown();
        return formula.kind == Kind::constant_true ? "true" : "false";
    }

    std::string interval(const Formula& formula) const {
        if (looks_one_step_away(formula.kind)) return "";
        if (is_shown(formula) && formula.low == 0 && formula.high == kUnbounded) return "";
        const std::string high = !is_shown(formula)           ? "calibrated"
                                 : formula.high == kUnbounded ? "inf"
                                                              : std::to_string(formula.high);
        if (formula.kind == Kind::held) return '[' + high + ']';
        return '[' + std::to_string(formula.low) + ", " + high + ']';
    }

    const Model& model_;
    Index root_;
    bool has_results_;
    std::unordered_map<Index, std::string> let_names_;
};

}  // namespace

std::vector<Index> measured_targets(const Model& model, const Predicate& predicate) {
    std::vector<Index> distances = predicate.distances();
    std::erase_if(distances, [&](Index d) { return model.distances[d].is_between_points(); });
    return distances;
}

const Let* let_with_truth(const Model& model, Index formula) {
    for (const Let& let : model.lets)
        if (let.truth != kNone && let.formula == formula) return &let;
    return nullptr;
}

std::vector<Index> parts_of(const Model& model, Index formula) {
    std::vector<bool> seen(formula + 1);
    seen[formula] = true;
    std::vector<Index> parts;
    for (Index i = formula + 1; i-- > 0;) {
        if (!seen[i]) continue;
        parts.push_back(i);
        for (const Index operand : model.formulas[i].operands) seen[operand] = true;
    }
    return parts;
}

void set_duration(Model& model, const Monitor& monitor, std::uint32_t steps, Formula::Time time) {
    for (const Index root : {monitor.formula, monitor.true_formula()})
        for (const Index part : parts_of(model, root)) {
            Formula& formula = model.formulas[part];
            if (formula.time == Formula::Time::written) continue;
            formula.high = steps - (formula.kind == Kind::count ? 1 : 0);
            formula.time = time;
        }
}

bool lets_are_written_out(const Model& model, Index formula) {
    std::uint64_t size = 0;
    std::vector<Index> pending{formula};
    while (!pending.empty() && size <= kMaxPrinted) {
        const std::vector<Index>& operands = model.formulas[pending.back()].operands;
        pending.pop_back();
        pending.insert(pending.end(), operands.begin(), operands.end());
        ++size;
    }
    return pending.empty() && size <= kMaxPrinted;
}

std::string share_text(std::uint32_t k, std::uint32_t n) {
    std::uint64_t scale = 1;  // a share above (k - 1) / n, up to k / n
    while (k * scale / n * n <= (k - 1) * scale) scale *= 10;
    const std::size_t digits = std::to_string(scale).size() - 1;
    return k == n ? "1" : fmt::format("0.{:0{}}", k * scale / n, digits);
}

std::string print(const Model& model, Index formula) {
    std::unordered_map<Index, std::string> let_names;
    if (!lets_are_written_out(model, formula))
        for (const Let& let : model.lets)
            if (let.formula != kNone) let_names.try_emplace(let.formula, let.name);
    return whole_text(formula, Phrases(model, formula, false, std::move(let_names)));
}

std::string shown(const Model& model, Index formula) {
    return elided_text(formula, Phrases(model, formula, true));
}

std::string print(const Model& model, const Expr& expression) {
    const auto leaf = [&](const Expr& e) {
        if (e.kind == Expr::Kind::scalar) return model.inputs[e.index].name;
        if (e.kind == Expr::Kind::distance) return model.distances[e.index].text;
        if (e.kind == Expr::Kind::past) return model.pasts[e.index].text;
        return Decimal::parse(e.text).text();
    };
    std::string text;
    ast::append(text, expression, leaf, [](const Expr& e) -> const Expr& { return e; });
    return text;
}

}  // namespace etlc::check
