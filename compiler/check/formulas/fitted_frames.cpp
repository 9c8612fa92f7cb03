// Which frames something is fitted on: `where` of fitted(...), as a formula.
#include <fmt/format.h>

#include <set>
#include <vector>

#include "check/context/steps.hpp"
#include "check/formulas/formulas.hpp"
#include "check/formulas/horizons.hpp"
#include "check/guarantees/guarantees.hpp"

namespace etlc::check {

using diag::Code;

namespace {

/// The first predicate in the formula that nothing says the truth of; kNone where there is none.
Index without_truth(const Model& model, Index root) {
    std::vector<Index> pending{root};
    std::set<Index> visited;
    while (!pending.empty()) {
        const Index at = pending.back();
        pending.pop_back();
        if (!visited.insert(at).second) continue;
        const Formula& formula = model.formulas[at];
        const bool compares = formula.kind == Formula::Kind::predicate &&
                              model.predicates[formula.index].name.empty();
        if (compares && !is_own_truth(model, formula.index)) return at;
        pending.insert(pending.end(), formula.operands.begin(), formula.operands.end());
    }
    return kNone;
}

}  // namespace

void check_fitted_frames(Context& c) {
    for (Index i = 0; i < c.model.fitted.size(); ++i) {
        const ast::Formula& written = *c.fitted_where[i];
        if (written.kind == ast::Formula::Kind::constant_true) continue;
        const Index where = check_formula(c, written);
        c.model.fitted[i].where = where;
        if (where == kNone) continue;
        const std::vector<Reach> all = reaches(c.model);
        if (const Index future = all[where].future; future != kNone)
            c.report(Code::future_in_truth, c.operator_spans[future],
                     fmt::format("{} looks ahead; frames are chosen by what is true in the present "
                                 "and the past",
                                 operator_word(c.model.formulas[future].kind)))
                .note(written.span, "the frames are chosen here");
        if (const Index compared = without_truth(c.model, where); compared != kNone)
            c.report(Code::frames_without_truth, c.model.formulas[compared].span,
                     fmt::format("frames are chosen by what is true, and nothing says when '{}' is",
                                 c.model.predicates[c.model.formulas[compared].index].shown()))
                .note(
                    "name a predicate: its truth counts, from 'truth NAME = ...;' or an array "
                    "truth.NAME in the episodes");
    }
}

}  // namespace etlc::check
