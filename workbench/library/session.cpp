#include "library/session.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "diag/render.hpp"
#include "explain/report.hpp"
#include "ir/lower.hpp"
#include "plan/recorder_plan.hpp"
#include "source/escape.hpp"

namespace etlc::library {

Session::Session(source::File file, pipeline::Compiled compiled, const diag::Sink& sink,
                 std::uint64_t history)
    : file_(std::move(file)),
      compiled_(std::move(compiled)),
      warnings_(diag::render_text(file_, sink)),
      is_used_(model().inputs.size()),
      is_measured_(model().predicates.size()),
      samples_(model().inputs.size()),
      evaluator_(compiled_.plan),
      verdicts_(plan().monitors.size()),
      history_(history) {
    for (const plan::Monitor& monitor : plan().monitors)
        formulas_.push_back(check::shown(model(), model().monitors[monitor.index].formula));
    for (Index p = 0; p < model().predicates.size(); ++p) {
        names_.push_back(plan::column_name(model(), p));
        texts_.push_back(model().predicates[p].text + model().predicates[p].threshold.text);
    }
    for (const Index input : plan().inputs) is_used_[input] = true;
    for (const Index predicate : plan().predicates) is_measured_[predicate] = true;
    for (Index input = 0; input < samples_.size(); ++input)
        samples_[input].values.reserve(model().inputs[input].dimension);
    if (plan().recorder) recorder_.emplace(plan());
    if (history == 0) return;
    observations_.emplace(model(), plan().values, plan().predicates, plan().inputs);
    observations_->reserve(history);
    atoms_.emplace(observations_->plan());
}

const std::vector<etlmon::Verdict>& Session::step() {
    verdicts_ = evaluator_.step(samples_);
    if (recorder_) recorder_->step(evaluator_, verdicts_);
    if (observations_ && steps_ < history_) {
        atoms_->step(samples_);
        observations_->add(*atoms_);
    }
    ++steps_;
    return verdicts_;
}

const std::vector<etlmon::Verdict>& Session::finish() {
    is_ended_ = true;
    verdicts_ = evaluator_.finish();
    if (recorder_) recorder_->finish(verdicts_);
    return verdicts_;
}

void Session::restart(std::size_t monitor) {
    evaluator_.restart(monitor);
    if (recorder_) recorder_->restart(monitor);
}

void Session::reset() {
    evaluator_.reset();
    if (recorder_) recorder_->end_episode();
    if (observations_) {
        atoms_->reset();
        observations_->clear();
    }
    std::fill(verdicts_.begin(), verdicts_.end(), etlmon::Verdict{});
    steps_ = 0;
    is_ended_ = false;
}

void Session::observe(Index predicate, float distance, bool truth) {
    const float before = evaluator_.threshold(predicate);
    evaluator_.observe(predicate, distance, truth);
    thresholds_moved_ = thresholds_moved_ || before != evaluator_.threshold(predicate);
}

std::string Session::why_unexplained() const {
    if (!observations_)
        return "no step was kept to explain a verdict with: open the spec with a history";
    if (steps_ > history_)
        return fmt::format(
            "the history holds {} of the episode's {} steps: open the spec with a "
            "longer one",
            history_, steps_);
    if (thresholds_moved_)
        return "adaptive thresholds have moved, and what they were at each step is not kept";
    return "";
}

const std::string& Session::explain(std::size_t monitor, bool as_json) {
    const explain::Question question{plan().monitors[monitor].index, evaluator_.position(monitor),
                                     steps_ - 1};
    const explain::Report report =
        explain::report(*observations_, ir::lower(model()), question, verdicts_[monitor]);
    explanation_ = as_json ? explain::json(report) : source::visible_lines(explain::text(report));
    return explanation_;
}

}  // namespace etlc::library
