// What is legal and surely not meant: declarations without use, predicates without choice.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "check/context/steps.hpp"
#include "check/formulas/formula_warnings.hpp"
#include "check/numbers/decimal.hpp"
#include "check/predicates/predicates.hpp"
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
            continue;  // broken, or not yet calibrated
        const auto answer = predicate.constant_answer();
        if (!answer) continue;
        const Range& delta = predicate.delta;
        const std::string values = delta.low == delta.high
                                       ? fmt::format("{:.9g}", delta.low)
                                       : fmt::format("in [{:.9g}, {:.9g}]", delta.low, delta.high);
        c.report(Code::constant_predicate, predicate.span,
                 fmt::format("the comparison is {} true: its left side is {}",
                             *answer ? "always" : "never", values));
    }
}

/// cosine(z, t) >= 0.9: near, were it a similarity.
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

void warn_of_same_predicates(Context& c) {
    std::map<std::string, const Entity*> first;
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
        c.report(
             Code::same_definition, entity.span,
             fmt::format("'{}' is the same predicate as '{}'", entity.name, before->second->name))
            .note(before->second->span, fmt::format("'{}' is declared here", before->second->name));
    }
}

}  // namespace

void warn(Context& c) {
    // A name that was misspelt in its only use is no second cause.
    if (!c.sink.has_errors()) warn_of_unused(c);
    if (!c.sink.has_errors()) warn_of_bare_bounds(c);
    warn_of_constant_predicates(c);
    warn_of_similarities(c);
    warn_of_same_predicates(c);
    warn_about_formulas(c);
}

}  // namespace etlc::check
