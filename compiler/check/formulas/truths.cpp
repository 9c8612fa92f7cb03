// Checks truths of predicates and of lets, and `where` in fitted(...). The truth of a predicate is
// a formula over recorded inputs. In the truth of a let, in `where` and in the ground truth of a
// monitor, what has a truth stands for it.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "check/context/context.hpp"
#include "check/formulas/durations.hpp"
#include "check/formulas/formulas.hpp"
#include "check/formulas/horizons.hpp"
#include "check/guarantees/guarantees.hpp"
#include "check/numbers/decimal.hpp"
#include "check/points/points.hpp"
#include "check/predicates/predicates.hpp"
#include "check/time/time.hpp"

namespace etlc::check {

namespace {

using diag::Code;

/// Returns the node of a predicate for which `is` holds, at or below `root`; otherwise kNone.
template <class Is>
Index predicate_node(const Model& model, Index root, Is is) {
    for (const Index at : parts_of(model, root)) {
        const Formula& formula = model.formulas[at];
        if (formula.kind == Formula::Kind::predicate && is(formula.index)) return at;
    }
    return kNone;
}

/// Returns the lets that have a truth by their formulas.
std::map<Index, const Let*> lets_with_truth(const Model& model) {
    std::map<Index, const Let*> found;
    for (const Let& let : model.lets)
        if (let.truth != kNone) found.try_emplace(let.formula, &let);
    return found;
}

class TruthCheck {
public:
    explicit TruthCheck(Context& context) : c_(context) {}

    void run() {
        for_each_declaration<ast::Truth>(
            c_.spec, [&](const ast::Truth& declaration, Index) { add(declaration); });
        reaches_ = reaches(c_.model);
        for (const Written& written : written_) {
            if (look_ahead(written)) continue;
            if (written.of.kind == NameKind::predicate)
                of_predicate(written);
            else
                of_let(written);
        }
        refuse_nested();
    }

private:
    struct Written {
        const ast::Truth& declaration;
        Reference of;
        Index formula;

        const std::string& name() const { return declaration.subject.text; }
        Span span() const { return declaration.subject.span; }
    };

    void add(const ast::Truth& declaration) {
        c_.is_in_truth = true;
        const Index formula = check_formula(c_, *declaration.formula);
        c_.is_in_truth = false;
        const auto of = subject(declaration.subject);
        if (!of) return;
        const auto [first, is_new] =
            first_.try_emplace({of->kind, of->index}, declaration.subject.span);
        if (!is_new)
            c_.report(Code::duplicate_truth, declaration.subject.span,
                      fmt::format("a second truth of '{}'", declaration.subject.text))
                .note(first->second, "the first is here");
        else if (formula != kNone && !c_.scope.entity(*of).broken)
            written_.push_back({declaration, *of, formula});
    }

    /// Returns the predicate or let; nothing after an error. A truth is no use of it.
    std::optional<Reference> subject(const ast::Name& name) {
        const Reference* before = c_.scope.find(name.text);
        const bool used = before != nullptr && c_.scope.entity(*before).used;
        const Reference* found = find(c_, name, {NameKind::predicate, NameKind::let}, kWanted);
        if (before != nullptr) c_.scope.entity(*before).used = used;
        if (found == nullptr || found->kind == NameKind::unreadable) return std::nullopt;
        if (found->kind == NameKind::predicate || found->kind == NameKind::let) return *found;
        c_.report(Code::wrong_kind, name.span,
                  fmt::format("'{}' is {}; expected {}", name.text, word_with_article(found->kind),
                              kWanted))
            .note(c_.scope.entity(*found).span, fmt::format("'{}' is declared here", name.text));
        return std::nullopt;
    }

    /// Refuses operators that look ahead.
    bool look_ahead(const Written& written) {
        const Index future = reaches_[written.formula].future;
        if (future == kNone) return false;
        auto& error = c_.report(
            Code::future_in_truth, c_.operator_spans[future],
            fmt::format("{} looks ahead; the truth of '{}' may only look at the present and the "
                        "past",
                        word(future), written.name()));
        note_place(error, written, future);
        return true;
    }

    std::string_view word(Index formula) const {
        return ast::operator_of(c_.model.formulas[formula].kind)->symbol;
    }

    /// Where the part is in a let, notes where the truth is.
    void note_place(diag::Diagnostic& error, const Written& written, Index part) const {
        const Span place = c_.operator_spans[part];
        const Span truth = written.declaration.span;
        if (truth.begin <= place.begin && place.end <= truth.end) return;
        error.note(written.span(), fmt::format("the truth of '{}' is here", written.name()));
    }

    void of_predicate(const Written& written) {
        refuse_fitted(written);
        refuse_calibrated(written);
        c_.model.truths.push_back({written.of.index, written.formula, written.declaration.span});
    }

    /// Fitted elements are fitted to truths, so truths cannot use them.
    void refuse_fitted(const Written& written) {
        const Index at = predicate_node(c_.model, written.formula, [&](Index predicate) {
            bool found = false;
            for_each_distance(c_.model.predicates[predicate].expression, [&](Index distance) {
                found = found || rests_on_fitted(c_.model, c_.model.distances[distance]);
            });
            return found;
        });
        if (at == kNone) return;
        c_.report(Code::truth_of_fitted, c_.model.formulas[at].span,
                  fmt::format("the truth of '{}' uses '{}', which depends on fitted values; a "
                              "truth cannot",
                              written.name(), shown_predicate(at)));
    }

    void refuse_calibrated(const Written& written) {
        const Index at = predicate_node(c_.model, written.formula, [&](Index predicate) {
            return c_.model.predicates[predicate].threshold.origin != ThresholdOrigin::literal;
        });
        if (at == kNone) return;
        c_.report(Code::calibrated_in_truth, c_.model.formulas[at].span,
                  fmt::format("the truth of '{}' uses '{}', whose threshold is calibrated; a "
                              "truth has to be exact",
                              written.name(), shown_predicate(at)));
    }

    std::string shown_predicate(Index at) const {
        return c_.model.predicates[c_.model.formulas[at].index].shown();
    }

    void of_let(const Written& written) {
        Let& let = c_.model.lets[written.of.index];
        if (const Index future = reaches_[let.formula].future; future != kNone) {
            c_.report(Code::truth_of_let, written.span(),
                      fmt::format("'{}' looks ahead, so it has no value at its own step that a "
                                  "truth could judge",
                                  let.name))
                .note(c_.operator_spans[future], fmt::format("{} looks ahead here", word(future)));
            return;
        }
        if (const Let* other = let_with_truth(c_.model, let.formula); other != nullptr) {
            c_.report(Code::truth_of_let, written.span(),
                      fmt::format("'{}' is another name of '{}', which has a truth", let.name,
                                  other->name))
                .note(other->span, fmt::format("'{}' is declared here", other->name));
            return;
        }
        if (const Index at = node_without_truth(c_.model, written.formula); at != kNone) {
            c_.report(Code::frames_without_truth, c_.model.formulas[at].span,
                      fmt::format("in the truth of a let, predicates stand for their truths, but "
                                  "'{}' has none",
                                  shown_predicate(at)));
            return;
        }
        let.truth = written.formula;
        of_lets_.push_back(&written);
    }

    /// Refuses truths that use a let with a truth, since it might use itself.
    void refuse_nested() {
        const auto lets = lets_with_truth(c_.model);
        for (const Written* written : of_lets_) {
            for (const Index part : parts_of(c_.model, written->formula)) {
                const auto used = lets.find(part);
                if (used == lets.end()) continue;
                c_.report(Code::truth_of_let, written->span(),
                          fmt::format("the truth of '{}' uses '{}', which has a truth itself; "
                                      "expected predicates, inputs and other lets",
                                      written->name(), used->second->name));
                break;
            }
        }
    }

    static constexpr std::string_view kWanted = "a predicate or a let";

    Context& c_;
    std::map<std::pair<NameKind, Index>, Span> first_;
    std::vector<Written> written_;
    std::vector<const Written*> of_lets_;
    std::vector<Reach> reaches_;
};

}  // namespace

void check_truths(Context& c) {
    TruthCheck(c).run();
}

Index node_without_truth(const Model& model, Index root) {
    return predicate_node(model, root, [&](Index predicate) {
        return model.predicates[predicate].name.empty() && !is_own_truth(model, predicate);
    });
}

Index with_truths_of_lets(Context& c, Index formula) {
    const auto lets = lets_with_truth(c.model);
    if (lets.empty()) return kNone;
    std::map<Index, Index> truths;  // of the parts that differ from their truths
    std::vector<Index> parts = parts_of(c.model, formula);
    std::reverse(parts.begin(), parts.end());  // operands first
    for (const Index part : parts) {
        if (const auto let = lets.find(part); let != lets.end()) {
            truths[part] = let->second->truth;
            continue;
        }
        Formula copy = c.model.formulas[part];
        std::uint32_t depth = 0;
        for (Index& operand : copy.operands) {
            if (const auto of = truths.find(operand); of != truths.end()) operand = of->second;
            depth = std::max(depth, c.depths[operand]);
        }
        if (copy.operands == c.model.formulas[part].operands) continue;
        if (depth >= kMaxDepth) {
            c.report(Code::formula_too_deep, copy.span,
                     fmt::format("a formula of more than {} levels with the truths of its lets "
                                 "written out",
                                 kMaxDepth));
            return kNone;
        }
        truths[part] = add_formula(c, std::move(copy), c.operator_spans[part], depth + 1);
    }
    const auto found = truths.find(formula);
    return found == truths.end() ? kNone : found->second;
}

/// Equal selections of frames are one formula, so that etlc fit collects them once.
void check_fitted_frames(Context& c) {
    std::map<std::string, Index> first;  // by text
    for (Index i = 0; i < c.model.fitted.size(); ++i) {
        const ast::Formula& written = *c.fitted_where[i];
        if (written.kind == ast::Formula::Kind::constant_true) continue;
        const Index where = check_formula(c, written);
        c.model.fitted[i].where = where;
        if (where == kNone) continue;
        Index& selects = c.model.fitted[i].where;
        if (const Index truth = with_truths_of_lets(c, where); truth != kNone) selects = truth;
        const std::vector<Reach> all = reaches(c.model);
        if (const Index future = all[where].future; future != kNone)
            c.report(Code::future_in_truth, c.operator_spans[future],
                     fmt::format("{} looks ahead; frames are selected by the present and the past",
                                 ast::operator_of(c.model.formulas[future].kind)->symbol))
                .note(written.span, "the frames are selected here");
        if (const Index at = node_without_truth(c.model, selects); at != kNone)
            c.report(Code::frames_without_truth, c.model.formulas[at].span,
                     fmt::format("frames are selected by truths, but '{}' has none",
                                 c.model.predicates[c.model.formulas[at].index].shown()))
                .note(
                    "use a named predicate with a truth: 'truth NAME = ...;' or an array "
                    "truth.NAME in the episodes");
        if (lets_are_written_out(c.model, selects))
            selects = first.try_emplace(print(c.model, selects), selects).first->second;
    }
}

// Checks comparisons of a count, count(f, D) >= n: how often a formula began to hold within a time;
// and of a fraction, fraction(f, D) >= s: at which share of the steps of a time it held.

namespace {

using Kind = Formula::Kind;

/// Returns a share of n steps, rounded down, or up. The share is at most 1.
std::uint32_t steps_of(const Decimal& share, std::uint32_t n, bool up) {
    std::uint64_t digits = 0;  // those of the product before the digit in turn
    bool is_whole = true;
    const auto move = [&] {
        is_whole = is_whole && digits % 10 == 0;
        digits /= 10;
    };
    for (std::size_t i = share.digits.size(); i-- > 0; move())
        digits += std::uint64_t{n} * static_cast<std::uint64_t>(share.digits[i] - '0');
    for (std::int64_t i = share.exponent; i < 0 && digits > 0; ++i) move();
    if (share.exponent > 0) return n;
    return static_cast<std::uint32_t>(digits) + (up && !is_whole ? 1 : 0);
}

class CountCheck {
public:
    CountCheck(Context& context, const ast::Formula& written)
        : c_(context),
          written_(written),
          is_on_left_(is_count(*written.left)),
          count_(is_on_left_ ? *written.left : *written.right),
          is_share_(count_.past->kind == ast::PastKind::fraction),
          other_(is_on_left_ ? *written.right : *written.left) {}

    Index run() {
        const auto steps = window();
        counted_ = check_formula(c_, *count_.past->formula);
        if (!steps) return kNone;
        // A formula begins to hold at most at every second step.
        most_ = is_share_ ? *steps : *steps / 2 + *steps % 2;
        const auto number = is_share_ ? share_of(*steps) : whole_number(most_);
        if (!number || counted_ == kNone) return kNone;
        steps_ = *steps;
        if (count_.past->time.calibrated && !add_time(*number)) return kNone;
        return compared(*number);
    }

private:
    std::optional<std::uint32_t> window() {
        const ast::Bound& time = count_.past->time;
        if (time.calibrated && is_share_)
            return c_.no_value(Code::calibration_not_available, time.span,
                               "a longer time of a fraction also asks for more steps, so it makes "
                               "the monitor neither truer nor falser throughout; expected a time");
        if (time.calibrated) return kMaxPast;
        const std::string why = fmt::format("a {} is over a finite time", word());
        if (!is_finite_duration(c_, time, why)) return std::nullopt;
        const auto steps = bound_steps(c_, time);
        if (!steps) return std::nullopt;
        if (*steps == 0)
            return c_.no_value(Code::past_form, time.span,
                               fmt::format("a {} over no step; expected at least one", word()));
        if (*steps <= kMaxPast) return steps;
        return c_.no_value(Code::bound_too_large, time.span,
                           fmt::format("{} steps; a {} looks back {} steps at most", *steps, word(),
                                       std::uint32_t{kMaxPast}));
    }

    /// Notes that the time is calibrated. The shortest allows the number that is compared with.
    bool add_time(std::uint32_t number) {
        const bool is_above =
            comparison() == Comparison::greater || comparison() == Comparison::less_equal;
        const std::uint32_t times = std::max(number + (is_above ? 1U : 0U), 1U);
        time_ = Formula::Time::open;
        steps_ = 2 * times - 1;
        return add_duration(c_, *count_.past->time.calibrated, steps_, kMaxPast);
    }

    /// Returns the number on the other side, at most `most`.
    std::optional<std::uint32_t> whole_number(std::uint32_t most) {
        const bool is_number = other_.kind == ast::ExprKind::number;
        const auto whole = is_number ? Decimal::parse(other_.text).whole(kMaxPast) : std::nullopt;
        if (!whole)
            return c_.no_value(Code::past_form, other_.span,
                               "a count compares with a whole number, as in 'count(f, 60 s) >= 3'");
        if (*whole <= most) return static_cast<std::uint32_t>(*whole);
        return c_.no_value(Code::past_form, other_.span,
                           fmt::format("a formula begins to hold at most {} within {}; found {}",
                                       diag::counted(most, "time"),
                                       c_.file.text(count_.past->time.span), other_.text));
    }

    /// Returns the number of steps that the share on the other side is of n.
    std::optional<std::uint32_t> share_of(std::uint32_t n) {
        const bool is_number = other_.kind == ast::ExprKind::number;
        const Decimal share = Decimal::parse(is_number ? other_.text : "2");
        if (share > Decimal::parse("1"))
            return c_.no_value(Code::past_form, other_.span,
                               "a fraction compares with a number from 0 to 1, as in "
                               "'fraction(f, 5 s) >= 0.8'");
        const Comparison by = comparison();
        if (by == Comparison::equal || by == Comparison::not_equal)
            return c_.no_value(Code::past_form, written_.span,
                               "a fraction compares by >=, >, <= or <: whether it is equal depends "
                               "on how many steps there are");
        return steps_of(share, n, by == Comparison::greater_equal || by == Comparison::less);
    }

    std::string_view word() const { return ast::word(count_.past->kind); }

    Comparison comparison() const {
        return is_on_left_ ? written_.comparison : mirrored(written_.comparison);
    }

    Index compared(std::uint32_t number) {
        switch (comparison()) {
            case Comparison::greater_equal: return at_least(number);
            case Comparison::greater: return at_least(number + 1);
            case Comparison::less: return negated(at_least(number));
            case Comparison::less_equal: return negated(at_least(number + 1));
            case Comparison::equal: return exactly(number);
            case Comparison::not_equal: break;
        }
        return negated(exactly(number));
    }

    Index at_least(std::uint32_t number) {
        if (number == 0 || number > most_) {
            c_.report(
                Code::past_form, written_.span,
                fmt::format("a {} within {} is a number from 0 to {}, so this comparison "
                            "has the same answer at every step",
                            word(), c_.file.text(count_.past->time.span), is_share_ ? 1 : most_));
            return kNone;
        }
        if (!is_share_ && number > kMaxCount) {
            c_.report(
                Code::bound_too_large, other_.span,
                fmt::format("a count compares with at most {}; found {}", kMaxCount, other_.text));
            return kNone;
        }
        return add({.kind = Kind::count,
                    .index = number,
                    .each_step = is_share_,
                    .operands = {counted_},
                    .high = steps_ - 1,
                    .time = time_});
    }

    Index exactly(std::uint32_t number) {
        if (number == 0) return negated(at_least(1));
        const Index enough = at_least(number);
        if (number == most_) return enough;
        const Index more = negated(at_least(number + 1));
        if (enough == kNone || more == kNone) return kNone;
        return add({.kind = Kind::conjunction, .operands = {enough, more}});
    }

    Index negated(Index formula) {
        return formula == kNone ? kNone : add({.kind = Kind::negation, .operands = {formula}});
    }

    Index add(Formula formula) {
        std::uint32_t depth = 0;
        for (const Index operand : formula.operands) depth = std::max(depth, c_.depths[operand]);
        formula.span = written_.span;
        return add_formula(c_, std::move(formula), count_.span, depth + 1);
    }

    Context& c_;
    const ast::Formula& written_;
    bool is_on_left_;
    const ast::Expr& count_;
    bool is_share_;
    const ast::Expr& other_;
    Index counted_ = kNone;
    std::uint32_t steps_ = 0;
    Formula::Time time_ = Formula::Time::written;
    std::uint32_t most_ = 0;
};

}  // namespace

bool is_count(const ast::Expr& expression) {
    return expression.kind == ast::ExprKind::past && expression.past->formula != nullptr;
}

Index check_count(Context& context, const ast::Formula& comparison) {
    return CountCheck(context, comparison).run();
}

}  // namespace etlc::check
