#include "check/formulas/formulas.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "check/context/context.hpp"
#include "check/formulas/durations.hpp"
#include "check/formulas/horizons.hpp"
#include "check/predicates/predicates.hpp"
#include "check/time/time.hpp"
#include "data/text/subtask_name.hpp"

namespace etlc::check {

namespace {

using diag::Code;
using Kind = Formula::Kind;

/// Constants and operators have the same numbers in the syntax tree and in the model.
Kind kind_of(ast::Formula::Kind written) {
    static_assert(static_cast<int>(Kind::negation) ==
                  static_cast<int>(ast::Formula::Kind::negation));
    return static_cast<Kind>(written);
}

class FormulaCheck {
public:
    explicit FormulaCheck(Context& context) : c_(context) {}

    Index build(const ast::Formula& written) {
        if (written.kind == ast::Formula::Kind::name) return named(written);
        if (written.kind == ast::Formula::Kind::comparison) {
            if (is_count(*written.left) || is_count(*written.right)) return counted(written);
            return leaf(Kind::predicate, comparison_predicate(c_, written), written);
        }
        Formula formula;
        formula.kind = kind_of(written.kind);
        formula.span = written.span;
        bool good = set_interval(formula, written);
        std::uint32_t depth = 0;
        for (const ast::FormulaPtr& operand : written.operands) {
            const Index index = build(*operand);
            formula.operands.push_back(index);
            if (index == kNone)
                good = false;
            else
                depth = std::max(depth, c_.depths[index]);
        }
        if (!good) return kNone;
        if (is_too_deep(depth, written)) return kNone;
        return add_formula(c_, std::move(formula), written.operator_span, depth + 1);
    }

private:
    bool is_too_deep(std::uint32_t depth, const ast::Formula& written) {
        if (depth < kMaxDepth) return false;
        c_.report(
            Code::formula_too_deep, written.span,
            fmt::format("a formula of more than {} levels with its lets written out", kMaxDepth));
        return true;
    }

    Index counted(const ast::Formula& written) {
        const Index index = check_count(c_, written);
        return index == kNone || is_too_deep(c_.depths[index] - 1, written) ? kNone : index;
    }

    /// Adds an atom; kNone for kNone.
    Index leaf(Kind kind, Index index, const ast::Formula& written) {
        if (index == kNone) return kNone;
        Formula formula;
        formula.kind = kind;
        formula.index = index;
        formula.span = written.span;
        return add_formula(c_, std::move(formula), written.span, 1);
    }

    bool set_interval(Formula& formula, const ast::Formula& written) {
        if (looks_one_step_away(formula.kind)) formula.low = formula.high = 1;
        if (!written.interval) return true;
        if (written.interval->high.calibrated) return set_duration(formula, *written.interval);
        if (formula.kind == Kind::held &&
            !is_finite_duration(c_, written.interval->high, "a formula is held for a finite time",
                                "for what has held since the first step, write 'H f'"))
            return false;
        const auto steps = interval_steps(c_, *written.interval);
        if (!steps) return false;
        formula.low = steps->low;
        formula.high = steps->high;
        return true;
    }

    /// The interval ends with the calibrated duration of the monitor.
    bool set_duration(Formula& formula, const ast::Interval& written) {
        const bool has_low = formula.kind != Kind::held;
        const auto low = has_low ? lower_steps(c_, written.low) : std::optional(0U);
        if (!low || !add_duration(c_, *written.high.calibrated, *low, kMaxBound)) return false;
        formula.low = formula.high = *low;
        formula.time = Formula::Time::open;
        return true;
    }

    Index named(const ast::Formula& written) {
        if (data::subtask_name(written.name) && !c_.is_in_truth) {
            c_.report(Code::wrong_kind, written.span,
                      "only recordings know their subtask, so only a truth may compare it")
                .note("declare 'predicate NAME = ...;' and 'truth NAME = " + written.name + ";'");
            return kNone;
        }
        const ast::Name name{written.name, written.span};
        const Reference* found =
            find(c_, name, {NameKind::predicate, NameKind::let, NameKind::input},
                 "a predicate, a let or a bool input");
        if (found == nullptr || found->kind == NameKind::unreadable) return kNone;
        const Entity& entity = c_.scope.entity(*found);
        if (found->kind == NameKind::predicate)
            return entity.broken ? kNone : leaf(Kind::predicate, found->index, written);
        if (found->kind == NameKind::let)
            return entity.broken ? kNone : c_.model.lets[found->index].formula;
        if (found->kind == NameKind::input)
            return entity.broken ? kNone : input(found->index, written);
        auto& error =
            c_.report(Code::wrong_kind, written.span,
                      fmt::format("'{}' is {}; expected a predicate, a let or a bool input",
                                  written.name, word_with_article(found->kind)));
        error.note(entity.span, fmt::format("'{}' is declared here", written.name));
        if (found->kind == NameKind::monitor)
            error.note("use let to name a formula that is used more than once");
        if (found->kind == NameKind::target)
            error.note(fmt::format(
                "a predicate measures a distance to it: min l2(INPUT, {}) <= 0.5", written.name));
        return kNone;
    }

    Index input(Index index, const ast::Formula& written) {
        const Input& input = c_.model.inputs[index];
        if (input.type == InputType::boolean) return leaf(Kind::boolean_input, index, written);
        auto& error =
            c_.report(Code::not_a_formula, written.span,
                      fmt::format("'{}' is {}, which is neither true nor false", written.name,
                                  input.is_embedding() ? "an embedding" : "a scalar"));
        error.note(input.is_embedding()
                       ? fmt::format("compare its distance to a target: min l2({}, TARGET) <= 0.5",
                                     written.name)
                       : fmt::format("compare it with a number: {} > 0.5", written.name));
        return kNone;
    }

    Context& c_;
};

}  // namespace

Index add_formula(Context& c, Formula formula, Span operator_span, std::uint32_t depth) {
    c.model.formulas.push_back(std::move(formula));
    c.operator_spans.push_back(operator_span);
    c.depths.push_back(depth);
    return static_cast<Index>(c.model.formulas.size() - 1);
}

Index check_formula(Context& context, const ast::Formula& formula) {
    return FormulaCheck(context).build(formula);
}

// Builds lets after those that they name.

namespace {

/// A use of a let in the formula of another.
struct Use {
    Index let;
    Span span;
};

/// `pending` is empty, and kept from call to call for its memory.
std::vector<Use> lets_in(const Context& c, const ast::Formula& formula,
                         std::vector<const ast::Formula*>& pending) {
    std::vector<Use> uses;
    pending.push_back(&formula);
    while (!pending.empty()) {
        const ast::Formula& next = *pending.back();
        pending.pop_back();
        for (const ast::FormulaPtr& operand : next.operands) pending.push_back(operand.get());
        if (next.kind != ast::Formula::Kind::name) continue;
        const Reference* found = c.scope.find(next.name);
        if (found != nullptr && found->kind == NameKind::let)
            uses.push_back({found->index, next.span});
    }
    std::sort(uses.begin(), uses.end(),
              [](const Use& a, const Use& b) { return a.span.begin < b.span.begin; });
    return uses;
}

/// Orders lets depth-first without recursion, since a chain of lets may be as long as the spec.
class LetOrder {
public:
    explicit LetOrder(Context& context) : c_(context) {
        std::vector<const ast::Formula*> pending;
        for_each_declaration<ast::Let>(c_.spec, [&](const ast::Let& let, Index) {
            uses_.push_back(lets_in(c_, *let.formula, pending));
        });
        states_.resize(uses_.size());
    }

    std::vector<Index> run() {
        for (Index let = 0; let < uses_.size(); ++let)
            if (states_[let].mark == Mark::untouched) visit(let);
        return std::move(order_);
    }

private:
    enum class Mark : std::uint8_t { untouched, open, done };
    struct State {
        Mark mark = Mark::untouched;
        std::size_t next_use = 0;
    };

    void visit(Index root) {
        open(root);
        while (!path_.empty()) {
            const Index let = path_.back();
            State& state = states_[let];
            if (state.next_use == uses_[let].size()) {
                state.mark = Mark::done;
                order_.push_back(let);
                path_.pop_back();
                continue;
            }
            const Use& use = uses_[let][state.next_use++];
            if (states_[use.let].mark == Mark::untouched)
                open(use.let);
            else if (states_[use.let].mark == Mark::open)
                report_cycle(use);
        }
    }

    void open(Index let) {
        states_[let].mark = Mark::open;
        path_.push_back(let);
    }

    /// Reports the cycle from the let that is used, along the path, and back.
    void report_cycle(const Use& use) {
        const auto begin = std::find(path_.begin(), path_.end(), use.let);
        if (std::all_of(begin, path_.end(), [&](Index let) { return entity(let).broken; })) return;
        constexpr std::ptrdiff_t kShown = 20;
        std::string text;
        for (auto at = begin; at != path_.end() && at - begin < kShown; ++at)
            text += entity(*at).name + " -> ";
        if (path_.end() - begin > kShown) text += "... -> ";
        text += entity(use.let).name;
        auto& error =
            c_.report(Code::let_cycle, entity(use.let).span,
                      fmt::format("'{}' refers to itself: {}", entity(use.let).name, text));
        error.note(use.span, "the cycle closes here");
        for (auto at = begin; at != path_.end(); ++at) entity(*at).broken = true;
    }

    Entity& entity(Index let) { return c_.scope.entity(NameKind::let, let); }

    Context& c_;
    std::vector<std::vector<Use>> uses_;
    std::vector<State> states_;
    std::vector<Index> path_;
    std::vector<Index> order_;
};

}  // namespace

void choose_telemetry(Context& c) {
    if (c.options.judged_lets)
        for (Let& let : c.model.lets) let.telemetry = let.truth != kNone;
    if (!c.options.lets || c.sink.has_errors()) return;
    const std::vector<Reach> reach = reaches(c.model);
    bool any = false;
    for (Let& let : c.model.lets) {
        let.telemetry = let.formula != kNone && reach[let.formula].future == kNone;
        any = any || let.telemetry;
    }
    for (Index i = 0; i < c.model.lets.size(); ++i) {
        const Let& let = c.model.lets[i];
        c.scope.entity(NameKind::let, i).used = true;
        if (let.telemetry || let.formula == kNone) continue;
        diag::Diagnostic found{
            Code::let_without_value,
            fmt::format("'{}' looks ahead, so it has no value at its own step, and --lets omits it",
                        let.name)};
        found.span = let.span;
        found.is_allowed = any;
        c.sink.report(std::move(found))
            .note(c.operator_spans[reach[let.formula].future], "it looks ahead here")
            .note(fmt::format("'sliding monitor ... = {};' reports it as soon as it is known, if "
                              "its future is bounded",
                              let.name));
    }
    if (c.model.lets.empty())
        c.report(Code::let_without_value, {}, "--lets has no effect: the spec has no lets");
}

void check_lets(Context& c) {
    std::vector<const ast::Let*> written;
    for_each_declaration<ast::Let>(c.spec, [&](const ast::Let& let, Index) {
        written.push_back(&let);
        c.model.lets.push_back({let.name.text, kNone, let.name.span});
    });
    for (const Index let : LetOrder(c).run()) {
        const Index formula = check_formula(c, *written[let]->formula);
        c.model.lets[let].formula = formula;
        if (formula == kNone) c.scope.entity(NameKind::let, let).broken = true;
    }
}

}  // namespace etlc::check
