#include "plan_runner.hpp"

#include <algorithm>
#include <limits>

#include "ir/lower.hpp"
#include "opt/opt.hpp"
#include "restart_schedule.hpp"

namespace etlc::tests {

std::vector<execute::Sample> samples_of(const reference::Step& step) {
    std::vector<execute::Sample> samples;
    for (const std::vector<double>& values : step) {
        execute::Sample sample;
        sample.present = !values.empty();
        for (const double value : values) sample.values.push_back(static_cast<float>(value));
        samples.push_back(std::move(sample));
    }
    return samples;
}

reference::Verdict observed(const etlmon::Verdict& verdict) {
    using reference::Status;
    reference::Verdict result;
    if (!verdict.decided()) {
        result.final = verdict.final();
        return result;
    }
    result.status = verdict.satisfied()  ? Status::satisfied
                    : verdict.violated() ? Status::violated
                                         : Status::unknown;
    result.final = verdict.final();
    result.lower = verdict.lower;
    result.robustness = verdict.robustness;
    result.robustness_high = std::numeric_limits<double>::quiet_NaN();
    result.upper = verdict.upper;
    return result;
}

PlanRunner::PlanRunner(const check::Model& model, const plan::Limits& limits, check::Values values)
    : model_(model) {
    ir::Program program = ir::lower(model);
    opt::optimise(program);
    diag::Sink sink;
    plan_ = plan::plan(program, limits, sink, values);
    for (const diag::Diagnostic& diagnostic : sink.sorted())
        if (diagnostic.severity() == diag::Severity::error)
            refusal_ += std::string(refusal_.empty() ? "" : " ") +
                        std::string(diag::info(diagnostic.code).code);
    if (plan_) evaluator_.emplace(*plan_);
}

Observed PlanRunner::run(const reference::Trace& trace, const Labels* labels) {
    Observed result;
    evaluator_->reset();
    for (std::size_t n = 0; n < trace.size(); ++n) {
        for (plan::Index p = 0; labels != nullptr && p < model_.predicates.size(); ++p)
            if (model_.predicates[p].threshold.adaptation)
                for (const Label& label : (*labels)[n][p])
                    evaluator_->observe(p, label.distance, label.truth);
        for (std::size_t m = 0; m < plan_->monitors.size(); ++m) {
            const plan::Index monitor = plan_->monitors[m].index;
            if (model_.monitors[monitor].restarts != check::Restarts::never &&
                restarts_before(n, monitor))
                evaluator_->restart(m);
        }
        result.verdicts.push_back(verdicts(evaluator_->step(samples_of(trace[n]))));
        if (n % 2 == 1) take_from_lets(result.verdicts.back());
        result.positions.push_back(positions());
        result.telemetry.push_back(telemetry());
    }
    result.missing_steps = evaluator_->missing_steps();
    result.dependencies = dependencies();
    std::uint32_t calls = 0;
    for (const plan::Monitor& monitor : plan_->monitors)
        calls = std::max(calls, monitor.sliding ? monitor.horizon : 0);
    for (std::uint32_t call = 0; call < calls && !trace.empty(); ++call)
        result.finish.push_back(verdicts(evaluator_->finish()));
    return result;
}

Dependencies PlanRunner::dependencies() const {
    Dependencies result{std::vector<bool>(model_.predicates.size()),
                        std::vector<bool>(model_.inputs.size())};
    for (const plan::Index index : plan_->predicates) result.predicates[index] = true;
    for (const plan::Stream& stream : plan_->streams)
        if (stream.op == plan::StreamOp::flag) result.flags[stream.index] = true;
    return result;
}

std::vector<reference::Verdict> PlanRunner::verdicts(
    const std::vector<etlmon::Verdict>& from) const {
    std::vector<reference::Verdict> result(model_.monitors.size());
    for (std::size_t n = 0; n < from.size(); ++n)
        result[plan_->monitors[n].index] = observed(from[n]);
    return result;
}

void PlanRunner::take_from_lets(std::vector<reference::Verdict>& verdicts) const {
    for (std::size_t l = 0; l < plan_->lets.size(); ++l)
        for (std::size_t m = 0; m < model_.monitors.size(); ++m)
            if (model_.monitors[m].sliding && !model_.monitors[m].calibration &&
                model_.monitors[m].formula == model_.lets[plan_->lets[l].index].formula)
                verdicts[m] = observed(evaluator_->lets()[l]);
}

std::vector<std::uint64_t> PlanRunner::positions() const {
    std::vector<std::uint64_t> result(model_.monitors.size());
    for (std::size_t n = 0; n < plan_->monitors.size(); ++n)
        result[plan_->monitors[n].index] = evaluator_->position(n);
    return result;
}

std::vector<Observed::Predicate> PlanRunner::telemetry() const {
    std::vector<Observed::Predicate> result(model_.predicates.size());
    for (const plan::Index index : plan_->predicates) {
        result[index].computed = true;
        result[index].delta = static_cast<double>(evaluator_->distance(index));
        if (model_.predicates[index].plain_distance())
            result[index].nearest = evaluator_->nearest(index);
    }
    return result;
}

}  // namespace etlc::tests
