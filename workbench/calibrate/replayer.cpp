#include "calibrate/replayer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include "check/guarantees/provenance.hpp"
#include "plan/program/value_type.hpp"

namespace etlc::calibrate {

namespace {

using episodes::Label;
using Open = Guaranteed::Open;

/// A byte of a track for a boolean input.
enum class Flag : char { missing, no, yes };

// A byte of a track for a label, and for the label as recorded.
constexpr unsigned kRecorded = 2;
char byte_of(Label label, Label recorded) {
    return static_cast<char>(static_cast<unsigned>(label) | static_cast<unsigned>(recorded)
                                                                << kRecorded);
}
Label label_in(char byte) {
    return static_cast<Label>(static_cast<unsigned>(byte) & 3U);
}
Label recorded_in(char byte) {
    return static_cast<Label>(static_cast<unsigned>(byte) >> kRecorded);
}

/// Returns the formula of the truth that judges the guarantee.
Index true_formula(const check::Model& model, const Guaranteed& one) {
    const check::Monitor& monitor = model.monitors[one.monitor];
    return one.guarantee.formula == monitor.formula ? monitor.true_formula()
                                                    : one.guarantee.formula;
}

/// Returns the model with only these monitors, in which an input per watched predicate, appended in
/// their order, says whether the predicate was measured. Nothing is known in advance about the
/// values of calibrated predicates, because their thresholds change.
check::Model replayed(const check::Model& model, const std::vector<Guaranteed>& all,
                      const Watched& watched) {
    check::Model result = model;
    result.truths.clear();
    result.lets.clear();
    result.monitors.clear();
    for (const Guaranteed& one : all) {
        check::Monitor monitor = model.monitors[one.monitor];
        monitor.truth = true_formula(model, one);
        monitor.formula = one.guarantee.formula;
        if (one.guarantee.negated) {
            check::Formula negation;
            negation.kind = check::Formula::Kind::negation;
            negation.operands = {monitor.formula};
            monitor.formula = monitor.truth = static_cast<Index>(result.formulas.size());
            result.formulas.push_back(std::move(negation));
        }
        result.monitors.push_back(std::move(monitor));
    }
    measure_by_inputs(result, watched.predicates);
    for (const Index p : watched.predicates) {
        check::Predicate& predicate = result.predicates[p];
        if (predicate.threshold.origin == check::ThresholdOrigin::literal) continue;
        predicate.threshold = {};
        predicate.delta = predicate.robustness = check::kEverything;
    }
    return result;
}

using episodes::label_of;

/// Returns the recorded labels of each labelled predicate over the steps of a track.
std::vector<std::vector<Label>> labels_in(const Watched& watched, const std::string& track) {
    std::vector<std::size_t> places;
    std::size_t at = sizeof(float) * watched.predicates.size();
    for (std::size_t i = 0; i < watched.labelled.size(); ++i) places.push_back(at++);
    at += watched.flags.size();
    for (std::size_t i = 0; i < watched.dividing.size(); ++i) places.push_back(at++);
    std::vector<std::vector<Label>> labels(places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t step = 0; step < track.size(); step += watched.step_size())
            labels[i].push_back(recorded_in(track[step + places[i]]));
    return labels;
}

}  // namespace

void set(execute::Sample& sample, bool present, float value) {
    sample.present = present;
    sample.values.assign(present ? 1 : 0, value);
}

void measure_by_inputs(check::Model& model, const std::vector<Index>& predicates) {
    for (const Index p : predicates) {
        check::Input measured;
        measured.name = "measured." + std::to_string(p);  // no name of a spec has a dot
        check::Predicate& predicate = model.predicates[p];
        predicate.expression = {};
        predicate.expression.kind = check::Expr::Kind::scalar;
        predicate.expression.index = static_cast<Index>(model.inputs.size());
        predicate.inputs = {predicate.expression.index};
        model.inputs.push_back(std::move(measured));
    }
}

std::vector<Guaranteed> guaranteed(const check::Model& model, bool as_a_whole) {
    using Kind = check::Guarantee::Kind;
    std::vector<Guaranteed> found;
    for (Index m = 0; m < model.monitors.size(); ++m) {
        const check::Monitor& monitor = model.monitors[m];
        if (monitor.calibration.has_value() != as_a_whole) continue;
        if (monitor.duration && !monitor.duration->is_known) continue;  // it has no verdicts yet
        for (const check::Guarantee& guarantee : check::guarantees(model, monitor)) {
            const Kind kind = guarantee.kind;
            if (kind == Kind::nothing || kind == Kind::exact || kind == Kind::wrong ||
                kind == Kind::false_alarm)
                continue;
            const bool of_alarms = kind == Kind::missed_alarm || kind == Kind::satisfied_wrongly ||
                                   kind == Kind::satisfied_share;
            const bool again = !found.empty() && found.back().monitor == m &&
                               found.back().guarantee.part == guarantee.part;
            if (again)
                found.back().open = Open::unknown;
            else
                found.push_back({m, guarantee, of_alarms ? Open::violated : Open::satisfied});
        }
    }
    return found;
}

Watched watched_by(const check::Model& model, const std::vector<Guaranteed>& all,
                   const std::vector<Index>& labelled, const std::vector<Index>& in_all) {
    if (all.empty()) return {};
    std::set<Index> predicates;
    std::set<Index> judging;  // the truth
    std::set<Index> flags;
    for (const Guaranteed& one : all) {
        const auto of = check::predicates_of(model, one.guarantee.formula);
        predicates.insert(of.begin(), of.end());
        for (const Index formula : {one.guarantee.formula, true_formula(model, one)}) {
            const auto bools = check::flags_of(model, formula);
            flags.insert(bools.begin(), bools.end());
        }
        const auto truly = check::predicates_of(model, true_formula(model, one));
        judging.insert(truly.begin(), truly.end());
    }
    Watched result{{predicates.begin(), predicates.end()}, {}, {flags.begin(), flags.end()}, {}};
    for (const Index p : labelled)
        if (judging.contains(p)) result.labelled.push_back(p);
    std::set<Index> dividing(in_all.begin(), in_all.end());
    dividing.insert(labelled.begin(), labelled.end());
    for (const Index p : result.labelled) dividing.erase(p);
    result.dividing.assign(dividing.begin(), dividing.end());
    return result;
}

void add_step(const Watched& watched, const execute::Evaluator& measured,
              const episodes::Recording& recording, bool is_divided, std::string& track) {
    for (const Index p : watched.predicates) {
        const float delta = measured.distance(p);
        char bytes[sizeof delta];
        std::memcpy(bytes, &delta, sizeof delta);
        track.append(bytes, sizeof bytes);
    }
    const auto add = [&](Index p) {
        track += byte_of(recording.label(p), recording.recorded_label(p));
    };
    for (const Index p : watched.labelled) add(p);
    for (const Index f : watched.flags) {
        const execute::Sample& sample = recording.samples()[f];
        const bool is_there = sample.present && !sample.values.empty();
        const bool holds = is_there && sample.values[0] != 0;
        track += static_cast<char>(!is_there ? Flag::missing : holds ? Flag::yes : Flag::no);
    }
    for (const Index p : watched.dividing)
        is_divided ? add(p) : track.push_back(byte_of(Label::unknown, Label::unknown));
}

/// The steps of a track, in another order if one is given.
class Replayer::Steps final : public episodes::Frames {
public:
    Steps(Replayer& of, const std::string& track, const episodes::Order* order = nullptr)
        : of_(of),
          track_(track),
          order_(order),
          length_(order != nullptr ? order->size() : track.size() / of.watched_.step_size()),
          samples_(of.truth_.model.inputs.size()),
          labels_(of.model_.predicates.size(), Label::unknown) {}

    diag::Result<bool> next() override {
        if (frames_ == length_) return false;
        std::size_t at = (order_ != nullptr ? (*order_)[frames_] : frames_) * size_;
        std::size_t input = of_.model_.inputs.size();
        for (const Index p : of_.watched_.predicates) {
            std::memcpy(&of_.measured_[p], track_.data() + at, sizeof(float));
            at += sizeof(float);
            set(samples_[input++], !std::isnan(of_.measured_[p]), 0);
        }
        for (const Index p : of_.watched_.labelled) labels_[p] = label_in(track_[at++]);
        for (const Index f : of_.watched_.flags) {
            const auto flag = static_cast<Flag>(track_[at++]);
            set(samples_[f], flag != Flag::missing, flag == Flag::yes ? 1.0F : 0.0F);
        }
        ++frames_;
        return true;
    }
    const std::vector<execute::Sample>& samples() const override { return samples_; }
    Label label(Index predicate) const override { return labels_[predicate]; }
    std::uint64_t frames() const override { return frames_; }

private:
    Replayer& of_;
    const std::string& track_;
    const episodes::Order* order_;
    std::uint64_t length_;
    std::size_t size_ = of_.watched_.step_size();
    std::vector<execute::Sample> samples_;
    std::vector<Label> labels_;
    std::uint64_t frames_ = 0;
};

std::unique_ptr<Replayer> Replayer::make(const check::Model& model, std::vector<Guaranteed> all,
                                         Watched watched) {
    diag::Sink sink;  // a spec that exceeds the limits is reported when it is compiled
    check::Model judged = replayed(model, all, watched);
    episodes::GroundTruth truth = episodes::ground_truth(judged, watched.labelled);
    auto monitors = compile(std::move(judged), {}, sink);
    auto truths = compile(truth.model, {{}, check::Values::boolean}, sink);
    if (!monitors || !truths) return nullptr;
    return std::unique_ptr<Replayer>(new Replayer(model, std::move(all), std::move(watched),
                                                  std::move(*monitors), std::move(truth),
                                                  std::move(*truths)));
}

Replayer::Replayer(const check::Model& model, std::vector<Guaranteed> all, Watched watched,
                   Compiled monitors, episodes::GroundTruth truth, Compiled truths)
    : model_(model),
      all_(std::move(all)),
      watched_(std::move(watched)),
      monitor_plan_(std::move(monitors)),
      truth_(std::move(truth)),
      truth_plan_(std::move(truths)),
      monitors_(monitor_plan_.plan),
      truths_(truth_plan_.plan, &truth_),
      measured_(model.predicates.size()) {
    monitors_.evaluator().replace_predicate_values([this](Index p) {
        const auto& [value, inner] = thresholds_->predicates[p];
        return plan::value_of(model_.predicates[p], measured_[p], value, inner,
                              check::Values::robustness);
    });
    truths_.evaluator().replace_predicate_values([this](Index p) {
        return plan::value_of(model_.predicates[p], measured_[p],
                              model_.predicates[p].threshold.value, check::Values::boolean);
    });
}

std::vector<VerdictCounts> Replayer::replay(const std::string& track,
                                            const Thresholds& thresholds) {
    std::vector<VerdictCounts> counts(all_.size());
    Steps steps(*this, track);
    run(steps, thresholds, [&] {
        note(counts);
        return true;
    });
    return counts;
}

std::vector<Broken> Replayer::replay_variants(const std::string& track,
                                              const Thresholds& thresholds) {
    const std::vector<std::vector<Label>> labels = labels_in(watched_, track);
    std::vector<Broken> result;
    for (const auto& [variant, name] : episodes::kVariants) {
        for (const episodes::Order& order :
             episodes::orders(variant, labels, track.size() / watched_.step_size())) {
            Broken broken{variant, std::vector<Concluded>(all_.size())};
            Steps steps(*this, track, &order);
            run(steps, thresholds, [&] {
                conclude(broken.concluded);
                return true;
            });
            result.push_back(std::move(broken));
        }
    }
    return result;
}

void Replayer::run(episodes::Frames& steps, const Thresholds& thresholds,
                   const episodes::AfterStep& after_step) {
    thresholds_ = &thresholds;
    for (plan::Monitor& monitor : monitor_plan_.plan.monitors) {
        if (!monitor.shifted) continue;
        monitor.shift = thresholds.shifts[monitor.index].value;
        monitor.inner_shift = thresholds.shifts[monitor.index].inner;
    }
    episodes::replay(steps, {&monitors_, &truths_}, after_step, after_step);
}

/// Restarts the truth of a repeating monitor with it, so that both judge the same positions.
void Replayer::follow(Index m) {
    if (model_.monitors[all_[m].monitor].restarts == check::Restarts::when_final &&
        monitors_.verdict(m).final())
        truths_.restart(m);
}

void Replayer::note(std::vector<VerdictCounts>& counts) {
    for (Index m = 0; m < all_.size(); ++m) {
        if (!monitors_.reports(m)) continue;
        const etlmon::Verdict& predicted = monitors_.verdict(m);
        const etlmon::Verdict& actual = truths_.verdict(m);
        follow(m);
        ++counts[m].all;
        counts[m].unknown += predicted.unknown() ? 1 : 0;
        if (predicted.satisfied() && counts[m].first_satisfied == 0)
            counts[m].first_satisfied = counts[m].all;
        if (actual.unknown()) continue;
        if (actual.satisfied() && counts[m].first_truly_satisfied == 0)
            counts[m].first_truly_satisfied = counts[m].all;
        ++counts[m].steps;
        counts[m].satisfied += predicted.satisfied() ? 1 : 0;
        counts[m].violated += predicted.violated() ? 1 : 0;
        counts[m].truly_satisfied += actual.satisfied() ? 1 : 0;
        counts[m].falsely_satisfied += predicted.satisfied() && actual.violated() ? 1 : 0;
        counts[m].falsely_violated += predicted.violated() && actual.satisfied() ? 1 : 0;
    }
}

/// Adds the verdicts of a step of a variant.
void Replayer::conclude(std::vector<Concluded>& concluded) {
    for (Index m = 0; m < all_.size(); ++m) {
        if (!monitors_.reports(m)) continue;
        const check::Monitor& monitor = model_.monitors[all_[m].monitor];
        Concluded& of = concluded[m];
        const bool has_to_last = monitor.sliding && of.began;
        const bool repeats = monitor.restarts == check::Restarts::when_final;
        const auto add = [&](const etlmon::Verdict& verdict, bool& alarm, Label& so_far) {
            alarm |= repeats && verdict.alarm();
            const Label now = alarm ? Label::no : label_of(verdict);
            so_far = has_to_last ? std::min(so_far, now) : now;
        };
        add(monitors_.verdict(m), of.predicted_alarm, of.predicted);
        add(truths_.verdict(m), of.actual_alarm, of.actual);
        of.began = true;
        follow(m);
    }
}

}  // namespace etlc::calibrate
