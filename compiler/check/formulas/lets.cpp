// Builds lets after those that they name.
#include <fmt/format.h>

#include <algorithm>

#include "check/context/context.hpp"
#include "check/formulas/formulas.hpp"
#include "check/formulas/horizons.hpp"

namespace etlc::check {

namespace {

using diag::Code;

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
