#include "episodes/ground_truth.hpp"

namespace etlc::episodes {

GroundTruth ground_truth(const check::Model& model, const std::vector<Index>& labelled) {
    GroundTruth result{model, std::vector<Index>(model.predicates.size(), check::kNone)};
    for (const Index predicate : labelled) {
        check::Input label;
        label.name = "truth." + model.predicates[predicate].name;  // no name of the spec has a dot
        label.type = check::InputType::boolean;
        label.span = model.predicates[predicate].span;
        result.inputs[predicate] = static_cast<Index>(result.model.inputs.size());
        result.model.inputs.push_back(std::move(label));
    }
    for (check::Formula& formula : result.model.formulas) {
        if (formula.kind != check::Formula::Kind::predicate) continue;
        const Index label = result.inputs[formula.index];
        if (label == check::kNone) continue;
        formula.kind = check::Formula::Kind::boolean_input;
        formula.index = label;
    }
    for (check::Monitor& monitor : result.model.monitors) {
        monitor.calibration.reset();  // the truth needs no shift
        // It is asked about the positions of the monitor that it judges.
        if (monitor.restarts == check::Restarts::when_final)
            monitor.restarts = check::Restarts::on_request;
    }
    result.model.truths.clear();
    return result;
}

std::vector<Index> labelled_predicates(const GroundTruth& truth) {
    std::vector<Index> found;
    for (Index predicate = 0; predicate < truth.inputs.size(); ++predicate)
        if (truth.inputs[predicate] != check::kNone) found.push_back(predicate);
    return found;
}

plan::Sample sample_of(Label label) {
    if (label == Label::unknown) return {};
    return {true, {label == Label::yes ? 1.0F : 0.0F}};
}

}  // namespace etlc::episodes
