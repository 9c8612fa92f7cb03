#include "library/program.hpp"

#include "diag/render.hpp"
#include "plan/recorder_plan.hpp"

namespace etlc::library {

Program::Program(source::File file, Compiled compiled, const diag::Sink& sink)
    : file_(std::move(file)),
      compiled_(std::move(compiled)),
      tables_(std::make_shared<const execute::Tables>(compiled_.plan)),
      warnings_(diag::render_text(file_, sink)),
      is_used_(model().inputs.size()),
      is_measured_(model().predicates.size()) {
    for (const plan::Monitor& monitor : plan().monitors)
        formulas_.push_back(check::shown(model(), model().monitors[monitor.index].formula));
    for (Index p = 0; p < model().predicates.size(); ++p) {
        names_.push_back(plan::column_name(model(), p));
        texts_.push_back(model().predicates[p].text + model().predicates[p].threshold.text);
    }
    for (const Index input : plan().inputs) is_used_[input] = true;
    for (const Index predicate : plan().predicates) is_measured_[predicate] = true;
}

}  // namespace etlc::library
