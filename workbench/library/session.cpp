#include "library/session.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "explain/report.hpp"
#include "ir/lower.hpp"
#include "source/text.hpp"

namespace etlc::library {

Session::Session(std::shared_ptr<const Program> program, std::uint64_t history)
    : program_(std::move(program)), evaluator_(plan(), program_->tables()), history_(history) {
    make_room();
    if (plan().recorder) recorder_.emplace(plan());
    if (history == 0) return;
    observations_.emplace(model(), plan().values, plan().predicates, plan().inputs);
    observations_->reserve(history);
    atoms_.emplace(observations_->plan());
}

Session::Session(std::shared_ptr<const Program> program, Batch batch)
    : program_(std::move(program)),
      evaluator_(plan(), program_->tables()),
      batch_(std::move(batch)) {
    make_room();
}

Session::Session(std::shared_ptr<const Program> program, const Batch& batch,
                 std::uint64_t environment)
    : program_(std::move(program)), evaluator_(plan(), program_->tables()) {
    make_room();
    evaluator_.state() = batch.state(environment);
    is_ended_ = evaluator_.state().finished > 0;
    steps_ = batch.steps(environment);
    verdicts_ = evaluator_.state().verdicts;
}

Session::Session(const Session& other)
    : program_(other.program_),
      evaluator_(plan(), program_->tables()),
      steps_(other.steps_),
      is_ended_(other.is_ended_),
      recorder_(other.recorder_),
      history_(other.history_),
      thresholds_moved_(other.thresholds_moved_) {
    make_room();
    verdicts_ = other.verdicts_;
    evaluator_.state() = other.evaluator_.state();
    if (other.batch_) batch_.emplace(*other.batch_);
    if (!other.observations_) return;
    observations_.emplace(model(), plan().values, plan().predicates, plan().inputs);
    observations_->reserve(history_);
    observations_->take(*other.observations_);
    atoms_.emplace(observations_->plan());
    atoms_->state() = other.atoms_->state();
}

void Session::make_room() {
    samples_.resize(model().inputs.size());
    for (Index input = 0; input < samples_.size(); ++input)
        samples_[input].values.reserve(model().inputs[input].dimension);
    verdicts_.resize(plan().monitors.size());
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
