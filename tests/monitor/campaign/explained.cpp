// The explaining half of the campaign: compares every explanation with brute force.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "campaign.hpp"
#include "explain/explain.hpp"
#include "loading.hpp"
#include "plan_runner.hpp"
#include "reference/explanation.hpp"

namespace etlc::tests {
namespace {

using reference::Alteration;
using reference::Explained;
using reference::Outcome;
using reference::SampleSet;
using reference::Status;

constexpr int kTracesPerExplained = 3;
constexpr int kExplainedTries = 3000;
constexpr std::size_t kLongest = 40;

std::string words(Outcome said) {
    const char* status = said.status == Status::satisfied  ? "satisfied"
                         : said.status == Status::violated ? "violated"
                                                           : "unknown";
    return std::string(status) + (said.for_good ? " for good" : "");
}

Outcome outcome_from(explain::Status status, bool for_good) {
    return {status == explain::Status::satisfied  ? Status::satisfied
            : status == explain::Status::violated ? Status::violated
                                                  : Status::unknown,
            for_good};
}

/// The graph as formulas of the reference: bounds are those of the simplified formula.
reference::NormalForm form_of(const ir::Program& program) {
    using Kind = reference::Node::Kind;
    // In the order of ir/operators.def, in which an operator's dual follows it, && precedes ||.
    constexpr std::pair<Kind, bool> kKinds[] = {
        {Kind::constant, false},   {Kind::constant, true},   {Kind::predicate, false},
        {Kind::boolean, false},    {Kind::any, true},        {Kind::any, false},
        {Kind::eventually, false}, {Kind::eventually, true}, {Kind::until, false},
        {Kind::until, true},       {Kind::once, false},      {Kind::once, true},
        {Kind::since, false},      {Kind::since, true},      {Kind::at_least, false},
        {Kind::at_least, true}};
    reference::NormalForm form;
    for (ir::NodeId id = 0; id < program.graph.size(); ++id) {
        const ir::Node& node = program.graph[id];
        const auto [kind, dual] = kKinds[static_cast<std::size_t>(node.op)];
        form.nodes.push_back({kind, node.negated || dual, node.index, node.operands,
                              node.interval.low, node.interval.high});
    }
    form.roots = program.monitors;
    return form;
}

/// One explanation, and its checks.
class Judge {
public:
    Judge(const check::Model& model, const ir::Program& program,
          const explain::Observations& observations, const reference::Trace& trace,
          check::Values values, std::uint64_t position)
        : model_(model),
          observations_(observations),
          position_(position),
          step_(observations.steps() - 1),
          found_(explain::explain(program, observations, {0, position, step_})),
          written_(model, reference::normal_form(model), trace, values, 0, position, step_),
          reference_(model, form_of(program), trace, values, 0, position, step_) {}

    const explain::Explanation& found() const { return found_; }

    std::optional<std::string> mismatch() const {
        const auto bad = first_mismatch();
        if (!bad) return {};
        return fmt::format("position {} after step {}, {}: {}", position_, step_,
                           words(reference_.outcome()), *bad);
    }

private:
    std::optional<std::string> first_mismatch() const {
        const Outcome said = outcome_from(found_.status, found_.for_good);
        if (said != reference_.outcome()) return fmt::format("explained as {}", words(said));
        if (found_.status == explain::Status::unknown) return {};
        if (auto bad = samples()) return bad;
        if (auto bad = critical(reference_)) return bad;
        // However the formula is written; then its bounds may be looser.
        if (!said.for_good)
            if (auto bad = critical(written_)) return bad;
        if (auto bad = chain()) return bad;
        return change();
    }

    std::optional<std::string> samples() const {
        const SampleSet samples = set_of(found_.samples);
        if (reference_.outcome_with_only(samples) != reference_.outcome())
            return fmt::format("{} do not suffice", show(samples));
        for (const reference::Sample& sample : samples) {
            SampleSet rest = samples;
            rest.erase(sample);
            if (reference_.outcome_with_only(rest) == reference_.outcome())
                return fmt::format("{} would do without {}", show(samples), show({sample}));
        }
        if (const SampleSet expected = reference_.explanation(); samples != expected)
            return fmt::format("explained by {}, by the rule by {}", show(samples), show(expected));
        return {};
    }

    std::optional<std::string> critical(const Explained& reference) const {
        const auto critical = reference.critical();
        const SampleSet expected = critical ? SampleSet{*critical} : SampleSet{};
        const SampleSet found = found_.critical ? set_of({*found_.critical}) : SampleSet{};
        if (found == expected) return {};
        return fmt::format("critical {}, expected {}", show(found), show(expected));
    }

    /// The chain leads from the monitor's formula to the atom.
    std::optional<std::string> chain() const {
        const explain::Link& first = found_.chain.front();
        if (first.formula != model_.monitors[0].formula || first.position != position_)
            return "the chain begins elsewhere";
        for (const explain::Link& link : found_.chain)
            if (std::abs(link.robustness) != std::abs(found_.robustness + shift()))
                return "a formula of the chain has another value";
        if (!found_.critical) return {};
        const explain::Link& last = found_.chain.back();
        const check::Formula& atom = model_.formulas[last.formula];
        const explain::Atom& critical = observations_.atoms()[found_.critical->atom];
        const bool is_predicate = atom.kind == check::Formula::Kind::predicate;
        const bool is_flag = atom.kind == check::Formula::Kind::boolean_input;
        if (last.position != found_.critical->step || atom.index != critical.index ||
            !(critical.is_predicate ? is_predicate : is_flag))
            return fmt::format("the chain ends at {} at {}", check::print(model_, last.formula),
                               last.position);
        return {};
    }

    float shift() const {
        const auto& calibration = model_.monitors[0].calibration;
        return calibration ? calibration->value : 0;
    }

    bool turned(Outcome then) const {
        const Outcome now = reference_.outcome();
        return then.status != now.status || (now.for_good && !then.for_good);
    }

    /// The change flips the verdict, and a slightly smaller one does not.
    std::optional<std::string> change() const {
        if (found_.change) {
            const explain::Change& change = *found_.change;
            const auto with = [&](float measured) {
                return reference_.outcome_with(altered(change.sample, measured));
            };
            const auto as_said = [&](Outcome then) {
                return then == outcome_from(change.status, change.for_good) && turned(then);
            };
            if (!as_said(with(change.measured)) && !as_said(with(beyond(change))))
                return fmt::format("{} as {:.9g}: {}", show(set_of({change.sample})),
                                   change.measured, words(with(change.measured)));
        }
        for (explain::Index atom = 0; atom < observations_.atoms().size(); ++atom)
            for (std::uint64_t step = 0; step <= step_; ++step)
                if (auto bad = smaller_change({atom, step})) return bad;
        return {};
    }

    std::optional<std::string> smaller_change(const explain::Sample& sample) const {
        if (observations_.is_missing(sample)) return {};
        const float now = observations_.measured(sample);
        for (const float other : smaller_ones(sample, now)) {
            const Outcome then = reference_.outcome_with(altered(sample, other));
            if (turned(then))
                return fmt::format("{} as {:.9g} instead of {:.9g}: {}", show(set_of({sample})),
                                   other, now, words(then));
        }
        return {};
    }

    std::vector<float> smaller_ones(const explain::Sample& sample, float now) const {
        const bool found = found_.change.has_value();
        if (!observations_.atoms()[sample.atom].is_predicate)
            return found ? std::vector<float>{} : std::vector{now != 0 ? 0.0F : 1.0F};
        const check::Range& range = observations_.predicate(sample.atom).delta;
        const bool by_size = found && is_predicate(*found_.change);
        const float most = by_size ? smaller(*found_.change) : std::numeric_limits<float>::max();
        std::vector<float> others = points(sample.atom);
        for (const float end : {range.low, range.high}) {
            const float far = std::clamp(end, -1e6F, 1e6F);
            others.push_back(!by_size ? far : far < now ? now - most : now + most);
        }
        std::erase_if(others, [&](float other) {
            return !range.contains(other) || std::abs(other - now) > most;
        });
        return others;
    }

    /// Candidates for a flip by == or !=: all thresholds of the expression, their neighbours up to
    /// the rounding of a shift, and values between them.
    std::vector<float> points(explain::Index atom) const {
        std::set<float> thresholds;
        bool any_equality = false;
        for (const Alteration& one : altered({atom, 0}, 0)) {
            const check::Predicate& predicate = model_.predicates[one.index];
            any_equality = any_equality || predicate.equality();
            thresholds.insert(predicate.threshold.value);
        }
        if (!any_equality) return {};
        std::vector<float> result;
        for (const float threshold : thresholds)
            for (const float away : {-0.0625F, 0.0F, 0.0625F}) {
                result.push_back(threshold + away);
                if (shift() == 0) result.push_back(std::nextafter(threshold, threshold + away));
            }
        return result;
    }

    /// With a shift, robustness is rounded twice, unlike in the reference: allow a little more.
    float beyond(const explain::Change& change) const {
        if (shift() == 0 || !is_predicate(change)) return change.measured;
        const float by = 1e-6F;
        return change.measured < observations_.measured(change.sample) ? change.measured - by
                                                                       : change.measured + by;
    }

    bool is_predicate(const explain::Change& change) const {
        return observations_.atoms()[change.sample.atom].is_predicate;
    }
    /// Slightly less than its size; nothing for a tiny change.
    float smaller(const explain::Change& change) const {
        const float size = std::abs(change.measured - observations_.measured(change.sample));
        return std::max(0.0F, size - 0.001F);
    }

    /// A measurement belongs to all predicates that compare the same expression.
    std::vector<Alteration> altered(const explain::Sample& sample, float measured) const {
        const explain::Atom& atom = observations_.atoms()[sample.atom];
        if (!atom.is_predicate) return {{false, atom.index, sample.step, measured}};
        const auto text = [&](explain::Index p) {
            return check::print(model_, model_.predicates[p].expression);
        };
        std::vector<Alteration> result;
        for (explain::Index p = 0; p < model_.predicates.size(); ++p)
            if (text(p) == text(atom.index)) result.push_back({true, p, sample.step, measured});
        return result;
    }

    SampleSet set_of(const std::vector<explain::Sample>& samples) const {
        SampleSet result;
        for (const explain::Sample& sample : samples) {
            const auto [is_predicate, index] = observations_.atoms()[sample.atom];
            const auto span =
                is_predicate ? model_.predicates[index].span : model_.inputs[index].span;
            result.insert({sample.step, span.begin, is_predicate, index});
        }
        return result;
    }

    std::string show(const SampleSet& samples) const {
        std::string text = "{";
        for (const reference::Sample& sample : samples)
            text += fmt::format("{}{} at {}", text == "{" ? "" : ", ",
                                sample.is_predicate ? model_.predicates[sample.index].shown()
                                                    : model_.inputs[sample.index].name,
                                sample.step);
        return text + "}";
    }

    const check::Model& model_;
    const explain::Observations& observations_;
    std::uint64_t position_;
    std::uint64_t step_;
    explain::Explanation found_;
    Explained written_;    ///< the formula as written
    Explained reference_;  ///< the formula as monitored
};

/// Explains the monitor at its first position, and at another one; one in three as if it were
/// calibrated as a whole.
std::optional<std::string> mismatch_of(check::Model model, const reference::Trace& trace,
                                       check::Values values, std::uint64_t seed, Tally* tally) {
    if (values == check::Values::robustness && seed % 3 == 0) {
        model.monitors[0].calibration.emplace();
        model.monitors[0].calibration->value =
            0.25F * static_cast<float>(static_cast<int>(seed % 9) - 4);
    }
    const ir::Program program = ir::lower(model);
    std::vector<check::Index> predicates(model.predicates.size());
    std::iota(predicates.begin(), predicates.end(), 0);
    std::vector<check::Index> inputs(model.inputs.size());
    std::iota(inputs.begin(), inputs.end(), 0);
    explain::Observations observations(model, values, predicates, inputs);
    execute::Evaluator evaluator(observations.plan());
    for (const reference::Step& step : trace) {
        evaluator.step(samples_of(step));
        observations.add(evaluator);
    }
    for (const std::uint64_t position : {std::uint64_t{0}, seed % trace.size()}) {
        const Judge judge(model, program, observations, trace, values, position);
        if (auto bad = judge.mismatch()) return bad;
        if (tally == nullptr) continue;
        ++tally->explained;
        if (judge.found().for_good) ++tally->for_good;
        if (!judge.found().samples.empty()) ++tally->with_samples;
        if (judge.found().change) ++tally->with_change;
    }
    return {};
}

Trial trial_on(check::Values values, std::uint64_t seed) {
    return
        [=](const std::string& spec, const reference::Trace& trace) -> std::optional<std::string> {
            const auto model = load(spec);
            if (!model || trace.empty()) return {};
            return mismatch_of(*model, trace, values, seed, nullptr);
        };
}

}  // namespace

void try_explanations(const Effort& effort, Tally& tally) {
    constexpr std::uint64_t kBeyondCompiled = 3'000'000;
    for (std::uint64_t n = 0; tally.explained < effort.explained && !tally.enough(); ++n) {
        const Subject tried = subject(effort.seed, kBeyondCompiled + n, 1);
        const auto model = load(tried.spec());
        for (int t = 0; model && t < kTracesPerExplained; ++t) {
            const reference::Trace trace =
                subject_trace(*model, tried, t, std::min(effort.longest, kLongest));
            const std::uint64_t seed = tried.seed + static_cast<std::uint64_t>(t);
            const auto mismatch = mismatch_of(*model, trace, tried.values, seed, &tally);
            if (!mismatch) continue;
            tally.findings.push_back(shrink({tried.spec(), trace, *mismatch},
                                            trial_on(tried.values, seed), kExplainedTries));
            break;
        }
    }
}

}  // namespace etlc::tests
