// --retargetable: makes a model whose numbers may change while its monitors run. What cannot change
// between steps is refused; predicates may have any robustness, so bounds depend on no number; all
// predicates get names that contain no numbers.
#include <fmt/format.h>

#include <set>

#include "check/context/context.hpp"
#include "check/numbers/range.hpp"

namespace etlc::check {

namespace {

void refuse(Context& c, Span span, const std::string& what, const std::string& why) {
    c.report(diag::Code::not_retargetable, span,
             fmt::format("{}, which --retargetable does not support: {}", what, why));
}

void refuse_what_cannot_change(Context& c) {
    for (const Predicate& predicate : c.model.predicates)
        if (predicate.threshold.adaptation)
            refuse(c, predicate.threshold.span,
                   fmt::format("'{}' has an adaptive threshold", predicate.name),
                   "what it has learnt is about the distance to the original targets");
    for (const Drift& drift : c.model.drifts)
        refuse(c, drift.span, fmt::format("'{}' is a drift", drift.name),
               "the scores of calibration are those of the original targets");
    for (const Monitor& monitor : c.model.monitors) {
        if (monitor.duration)
            refuse(c, monitor.duration->threshold.span,
                   fmt::format("'{}' has a calibrated duration", monitor.name),
                   "it is valid only for the targets and thresholds that it was calibrated with");
        if (monitor.calibration)
            refuse(c, monitor.calibration->span,
                   fmt::format("'{}' is calibrated as a whole", monitor.name),
                   "its shift is valid only for episodes with one set of parameters from beginning "
                   "to end");
    }
}

/// Returns the names of fields, and of parts of function names, beside predicates.
std::set<std::string> names_of(const Model& model) {
    std::set<std::string> names;
    for (const Input& input : model.inputs) names.insert(input.name);
    for (const Predicate& predicate : model.predicates) names.insert(predicate.name);
    for (const Let& let : model.lets) names.insert(let.name);
    for (const Monitor& monitor : model.monitors) names.insert(monitor.name);
    return names;
}

}  // namespace

void make_retargetable(Context& c) {
    c.model.retargetable = true;
    refuse_what_cannot_change(c);
    std::set<std::string> names = names_of(c.model);
    std::size_t number = 0;
    for (Predicate& predicate : c.model.predicates) {
        predicate.delta = predicate.robustness = kEverything;
        while (predicate.name.empty())
            if (const std::string name = fmt::format("comparison_{}", ++number);
                names.insert(name).second)
                predicate.name = name;
    }
}

}  // namespace etlc::check
