// Warns of declarations and formulas that are legal but surely not intended.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "check/context/context.hpp"
#include "check/formulas/horizons.hpp"
#include "check/numbers/decimal.hpp"
#include "check/time/time.hpp"

namespace etlc::check {

namespace {

using diag::Code;

void warn_of_unused(Context& c) {
    for (const NameKind kind :
         {NameKind::constant, NameKind::encoder, NameKind::input, NameKind::projection,
          NameKind::target, NameKind::predicate, NameKind::let}) {
        for (const Entity& entity : c.scope.all(kind)) {
            if (entity.used || c.used_constants.contains(entity.name)) continue;
            c.report(Code::unused_declaration, entity.span,
                     fmt::format("{} '{}' is not used", word(kind), entity.name));
        }
    }
}

void warn_of_constant_predicates(Context& c) {
    for (const Predicate& predicate : c.model.predicates) {
        if (predicate.text.empty() || std::isnan(predicate.threshold.value))
            continue;  // broken or not yet calibrated
        const auto answer = predicate.constant_answer();
        if (!answer) continue;
        const Range& delta = predicate.delta;
        const std::string values = delta.low == delta.high
                                       ? fmt::format("{:.9g}", delta.low)
                                       : fmt::format("in [{:.9g}, {:.9g}]", delta.low, delta.high);
        const bool turns = predicate.missing == !*answer;  // where a sample is missing
        auto& warning = c.report(
            Code::constant_predicate, predicate.span,
            fmt::format("{}the comparison is {} true: its left side is {}",
                        turns ? "with its samples " : "", *answer ? "always" : "never", values));
        if (turns) warning.note(fmt::format("where one is missing it counts as {}", !*answer));
    }
}

/// cosine(z, t) >= 0.9 would mean near if cosine were a similarity.
void warn_of_similarities(Context& c) {
    for (const Predicate& predicate : c.model.predicates) {
        if (predicate.text.empty() || !predicate.plain_distance() || !predicate.lower_bound())
            continue;
        const bool is_cosine =
            c.model.distances[predicate.expression.index].metric == Metric::cosine;
        const Threshold& threshold = predicate.threshold;
        if (!is_cosine || threshold.origin != ThresholdOrigin::literal) continue;
        if (!(threshold.value64 > 0.5 && threshold.value64 <= 1)) continue;
        c.report(Code::similarity_meant, predicate.span,
                 "cosine is a distance: 0 where directions agree, 1 at a right angle, 2 at most")
            .note(fmt::format("a similarity of at least {} is a distance of at most {:.6g}",
                              threshold.text, 1 - threshold.value64));
    }
}

void report_same(Context& c, std::string_view kind, const Entity& entity, const Entity& first) {
    c.report(Code::same_definition, entity.span,
             fmt::format("'{}' is the same {} as '{}'", entity.name, kind, first.name))
        .note(first.span, fmt::format("'{}' is declared here", first.name));
}

void warn_of_same_predicates(Context& c) {
    std::unordered_map<std::string, const Entity*> first;
    for (Index i = 0; i < c.scope.all(NameKind::predicate).size(); ++i) {
        const Predicate& predicate = c.model.predicates[i];
        const Entity& entity = c.scope.entity(NameKind::predicate, i);
        if (entity.broken || entity.duplicate ||
            predicate.threshold.origin != ThresholdOrigin::literal)
            continue;
        std::string text = predicate.text + Decimal::parse(predicate.threshold.text).text();
        if (predicate.missing) text += fmt::format(" missing {}", *predicate.missing);
        const auto [before, is_new] = first.try_emplace(text, &entity);
        if (is_new) continue;
        report_same(c, "predicate", entity, *before->second);
    }
}

// ---- formulas, one warning for each operator or monitor
// -------------------------------------------

using Kind = Formula::Kind;

/// Numbers the formulas; those of the same structure have the same number.
std::vector<Index> structures(const Model& model) {
    struct Hash {
        std::size_t operator()(const std::vector<Index>& key) const {
            const std::string_view bytes(reinterpret_cast<const char*>(key.data()),
                                         key.size() * sizeof(Index));
            return std::hash<std::string_view>()(bytes);
        }
    };
    std::unordered_map<std::vector<Index>, Index, Hash> known(model.formulas.size());
    std::vector<Index> result;
    result.reserve(model.formulas.size());
    std::vector<Index> key;
    for (const Formula& formula : model.formulas) {
        key = {static_cast<Index>(formula.kind), formula.index, formula.low, formula.high};
        if (formula.time == Formula::Time::open)
            key.push_back(static_cast<Index>(result.size()));  // differs from all others
        const auto first = static_cast<std::ptrdiff_t>(key.size());
        for (const Index operand : formula.operands) key.push_back(result[operand]);
        const bool commutes = formula.kind == Kind::conjunction ||
                              formula.kind == Kind::disjunction ||
                              formula.kind == Kind::equivalence;
        if (commutes) std::sort(key.begin() + first, key.end());
        result.push_back(known.try_emplace(key, static_cast<Index>(known.size())).first->second);
    }
    return result;
}

bool is_unbounded(const Formula& formula, Kind kind) {
    return formula.kind == kind && formula.high == kUnbounded;
}

class FormulaWarnings {
public:
    explicit FormulaWarnings(Context& context)
        : c_(context),
          model_(context.model),
          structures_(structures(model_)),
          constancies_(constancies(model_)),
          reaches_(reaches(model_)),
          so_far_(decidable(model_, Lasts::so_far, true)),
          for_good_(decidable(model_, Lasts::for_good, true)),
          below_(model_.formulas.size(), kNone) {}

    void run() {
        for (Index i = 0; i < model_.formulas.size(); ++i) {
            warn_of_same_operands(i);
            warn_of_eventual_implication(i);
        }
        const std::vector<bool> in_prefix = below_prefix_monitors();
        for (Index i = 0; i < model_.formulas.size(); ++i)
            if (in_prefix[i]) warn_of_last_step(i);
        for (Index i = 0; i < model_.monitors.size(); ++i) {
            const Monitor& monitor = model_.monitors[i];
            const Entity& entity = c_.scope.entity(NameKind::monitor, i);
            if (monitor.formula == kNone) continue;
            if (!warn_of_constant(monitor, entity.span) &&
                !warn_of_first_position(monitor, entity.span))
                warn_of_past_at_start(monitor);
            warn_of_same_monitor(monitor, entity);
        }
    }

private:
    std::vector<bool> below_prefix_monitors() const {
        std::vector<bool> found(model_.formulas.size());
        for (const Monitor& monitor : model_.monitors)
            if (monitor.formula != kNone && !monitor.sliding) found[monitor.formula] = true;
        for (std::size_t i = found.size(); i-- > 0;)
            if (found[i])
                for (const Index operand : model_.formulas[i].operands) found[operand] = true;
        return found;
    }

    /// Warns of an operand that occurs twice or with its negation: `p || p`, `p U p`, `p && !p`.
    void warn_of_same_operands(Index at) {
        const Formula& formula = model_.formulas[at];
        if (formula.operands.size() < 2) return;
        for (const Index operand : formula.operands) {
            if (std::exchange(below_[structures_[operand]], at) != at) continue;
            c_.report(Code::same_operands, c_.operator_spans[at],
                      fmt::format("{} has the operand '{}' twice",
                                  ast::operator_of(formula.kind)->symbol, shown(model_, operand)));
            return;
        }
        for (const Index operand : formula.operands) {
            if (model_.formulas[operand].kind != Kind::negation) continue;
            const Index inner = model_.formulas[operand].operands[0];
            if (below_[structures_[inner]] != at) continue;
            c_.report(Code::same_operands, c_.operator_spans[at],
                      fmt::format("{} has the operand '{}' and its negation",
                                  ast::operator_of(formula.kind)->symbol, shown(model_, inner)));
            return;
        }
    }

    void warn_of_eventual_implication(Index at) {
        const Formula& formula = model_.formulas[at];
        if (formula.kind != Kind::eventually ||
            model_.formulas[formula.operands[0]].kind != Kind::implication)
            return;
        const Formula& implication = model_.formulas[formula.operands[0]];
        const std::string left = shown(model_, implication.operands[0]);
        c_.report(
              Code::eventual_implication, c_.operator_spans[at],
              fmt::format("F of an implication holds as soon as its left side '{}' does not", left))
            .note(
                "G (a -> F b) means that every a is followed by a b, F (a && b) that both hold at "
                "the same time");
    }

    void warn_of_last_step(Index at) {
        const Formula& outer = model_.formulas[at];
        if (outer.operands.size() != 1) return;
        const Formula& inner = model_.formulas[outer.operands[0]];
        const bool eventually_always =
            is_unbounded(outer, Kind::eventually) && is_unbounded(inner, Kind::always);
        const bool always_eventually =
            is_unbounded(outer, Kind::always) && is_unbounded(inner, Kind::eventually);
        if (!eventually_always && !always_eventually) return;
        const std::string_view words = eventually_always ? "F G" : "G F";
        auto& warning = c_.report(
            Code::last_step_only, c_.operator_spans[at],
            inner.low == 0
                ? fmt::format(
                      "on a growing prefix, {} only means that its operand holds at the last step",
                      words)
                : fmt::format("on a growing prefix, the inner operator of {} looks past the last "
                              "step, where it is {}",
                              words, eventually_always ? "always satisfied" : "never satisfied"));
        warning.note(
            "every operator ends with the prefix; a bound helps, as in G F[0, b] p or F G[0, b] p");
    }

    bool warn_of_constant(const Monitor& monitor, Span name) {
        const Constancies& found = constancies_[monitor.formula];
        const bool anywhere = monitor.sliding || monitor.restarts != Restarts::never;
        const Constancy constancy = anywhere ? found.anywhere : found.at_start;
        if (constancy == Constancy::varies) return false;
        auto& warning = c_.report(
            Code::constant_verdict, name,
            fmt::format("'{}' is {} from the first step, whatever the inputs are", monitor.name,
                        constancy == Constancy::always ? "satisfied" : "violated"));
        if (!anywhere && found.anywhere == Constancy::varies)
            warning.note(
                "a prefix monitor reports about position 0, which has no past; did you mean a "
                "sliding monitor?");
        return true;
    }

    bool warn_of_first_position(const Monitor& monitor, Span name) {
        if (monitor.sliding || monitor.restarts != Restarts::never ||
            reaches_[monitor.formula].future != kNone)
            return false;
        c_.report(Code::first_position_only, name,
                  fmt::format("'{}' looks only at position 0, so that its verdict never changes "
                              "after the first step",
                              monitor.name))
            .note("did you mean a sliding monitor, or G in front of the formula?");
        return true;
    }

    /// Warns where no step can bring a verdict because predicates lack their past at position 0.
    void warn_of_past_at_start(const Monitor& monitor) {
        if (monitor.sliding) return;
        const Index f = monitor.formula;
        if (so_far_[f].satisfied > 0 && decidable(model_, Lasts::so_far, false)[f].satisfied == 0)
            report_past_at_start(monitor, so_far_, true);
        else if (for_good_[f].violated > 0 &&
                 decidable(model_, Lasts::for_good, false)[f].violated == 0)
            report_past_at_start(monitor, for_good_, false);
    }

    using First = std::vector<Decidable>;

    /// Returns the operator that needs the past at position 0, and turns `satisfied` with each
    /// negation above it.
    Index needs_past(const First& first, Index at, bool& satisfied) const {
        const Formula& formula = model_.formulas[at];
        const auto operand = [&](Index i, bool turned) {
            satisfied = satisfied != turned;
            return needs_past(first, formula.operands[i], satisfied);
        };
        if (formula.kind == Kind::negation) return operand(0, true);
        if (formula.kind == (satisfied ? Kind::conjunction : Kind::disjunction))
            for (Index i = 0; i < formula.operands.size(); ++i)
                if (first[formula.operands[i]].position(satisfied) > 0) return operand(i, false);
        if (formula.kind != Kind::implication || satisfied) return at;
        return first[formula.operands[1]].violated > 0 ? operand(1, false) : operand(0, true);
    }

    /// Returns the predicate of the formula that needs most of the past.
    Index with_most_past(Index formula, std::uint64_t& most) const {
        Index found = kNone;
        for (const Index part : parts_of(model_, formula)) {
            if (model_.formulas[part].kind != Kind::predicate) continue;
            const auto needed = past_needed(model_, model_.predicates[model_.formulas[part].index]);
            if (needed <= most) continue;
            most = needed;
            found = part;
        }
        return found;
    }

    void report_past_at_start(const Monitor& monitor, const First& first, bool satisfied) {
        const std::string verdict = satisfied ? "satisfied" : "violated for good";
        const Index at = needs_past(first, monitor.formula, satisfied);
        std::uint64_t most = 0;
        const Index predicate = with_most_past(at, most);
        if (predicate == kNone) return;
        const auto missing = model_.predicates[model_.formulas[predicate].index].missing;
        auto& warning = c_.report(
            Code::past_at_start, c_.operator_spans[at],
            fmt::format("'{}' can never be {}: '{}' needs {} of past, and {} before", monitor.name,
                        verdict, shown(model_, predicate), diag::counted(most, "step"),
                        missing ? fmt::format("counts as {}", *missing) : "is unknown"));
        const Formula& formula = model_.formulas[at];
        const auto known_from = [&](Index f) {
            const std::uint64_t back = steps_read_back(model_, f);
            return std::max(first[f].position(satisfied), back == Gap::kForGood ? 0 : back);
        };
        const std::uint64_t from = known_from(at);
        if (from == Decidable::kNever) return;
        std::string op = "G" + interval_text(c_, from, from);
        Index operand = at;
        if (formula.kind == Kind::always || formula.kind == Kind::eventually) {
            operand = formula.operands[0];
            const std::uint64_t known = known_from(operand);
            const bool ends_before = known > formula.high;  // not where it has no end
            const std::uint64_t high =
                ends_before ? known + (formula.high - formula.low) : formula.high;
            op = fmt::format("{}{}", ast::operator_of(formula.kind)->symbol,
                             interval_text(c_, known, high));
            if (formula.low == 0 && formula.high == kUnbounded) warning.meant = op;
        }
        warning.note(fmt::format("begin where it is known: '{} {}'", op, in_brackets(operand)));
    }

    /// Returns the text of a formula as the operand of a prefix operator, as it is written if that
    /// is short.
    std::string in_brackets(Index f) const {
        const Formula& formula = model_.formulas[f];
        constexpr std::size_t kShort = 60;
        const std::string_view written = c_.file.text(formula.span);
        const bool is_short = written.size() <= kShort && written.find('\n') == written.npos;
        const std::string text = is_short ? std::string(written) : shown(model_, f);
        const ast::Operator* const op = ast::operator_of(formula.kind);
        const bool is_comparison =
            formula.kind == Kind::predicate && model_.predicates[formula.index].name.empty();
        const bool alone = op == nullptr ? !is_comparison : op->level == ast::kPrefix;
        return alone ? text : fmt::format("({})", text);
    }

    void warn_of_same_monitor(const Monitor& monitor, const Entity& entity) {
        if (monitor.calibration) return;                       // each has its own shift
        if (monitor.restarts == Restarts::on_request) return;  // each restarts at its own time
        const auto [first, is_new] = monitors_.try_emplace(
            {structures_[monitor.formula], monitor.sliding, monitor.restarts}, &entity);
        if (is_new) return;
        report_same(c_, "monitor", entity, *first->second);
    }

    Context& c_;
    const Model& model_;
    std::vector<Index> structures_;
    std::vector<Constancies> constancies_;
    std::vector<Reach> reaches_;
    std::vector<Decidable> so_far_;
    std::vector<Decidable> for_good_;
    std::vector<Index> below_;  ///< for each structure the last formula with such an operand
    std::map<std::tuple<Index, bool, Restarts>, const Entity*> monitors_;
};

}  // namespace

void warn(Context& c) {
    // A name misspelt in its only use is reported already.
    if (!c.sink.has_errors()) warn_of_unused(c);
    if (!c.sink.has_errors()) warn_of_bare_bounds(c);
    if (!c.options.retargetable) warn_of_constant_predicates(c);  // thresholds may change
    warn_of_similarities(c);
    warn_of_same_predicates(c);
    FormulaWarnings(c).run();
}

}  // namespace etlc::check
