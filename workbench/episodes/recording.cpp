#include "episodes/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "check/encoders/encoders.hpp"
#include "check/points/points.hpp"
#include "data/text/text.hpp"
#include "data/traces/trace_formats.hpp"
#include "etlmon/distance/between.hpp"
#include "recordings/datasets/trace.hpp"

namespace etlc::episodes {

namespace {

using check::Input;
using check::InputType;

/// Samples of fewer bits coincide by chance.
constexpr std::uint32_t kBitsThatTell = 32;

std::uint32_t bits_of(const Input& input) {
    switch (input.type) {
        case InputType::f32: return 32 * input.dimension;
        case InputType::f16: return 16 * input.dimension;
        case InputType::i8: return 8 * input.dimension;
        case InputType::scalar:
        case InputType::boolean: break;
    }
    return 0;
}

/// Names an input with its declaration, because another declaration changes the samples that the
/// monitor sees.
std::string name_of(const Input& input) {
    std::string name = input.name;
    if (input.type == InputType::f16) name += " f16";
    if (input.type == InputType::i8) name += fmt::format(" i8 scale {:.9g}", input.scale);
    if (input.has_range)
        name += fmt::format(" in [{:.9g}, {:.9g}]", input.range.low, input.range.high);
    if (input.hold > 0) name += fmt::format(" hold {}", input.hold);
    if (input.missing) name += *input.missing ? " missing true" : " missing false";
    if (input.stale_after > 0) name += fmt::format(" stale after {}", input.stale_after);
    return name;
}

std::vector<recordings::HashedInput> hashed(const check::Model& model,
                                            const std::vector<Index>& inputs) {
    std::vector<recordings::HashedInput> result;
    for (const Index index : inputs) {
        const Input& input = model.inputs[index];
        result.push_back({name_of(input), input.dimension, bits_of(input) >= kBitsThatTell});
    }
    return result;
}

/// Returns whether a sample is present, finite and in range.
bool is_there(const Input& input, const execute::Sample& sample) {
    return sample.present && !sample.values.empty() &&
           execute::all_finite(sample.values.data(), sample.values.size()) &&
           (input.type != InputType::scalar || input.range.contains(sample.values[0]));
}

void see_as(const Input& input, const std::vector<float>& values, std::vector<float>& seen) {
    seen.resize(values.size());
    const bool is_bool = input.type == InputType::boolean;
    if (is_bool) seen[0] = values[0] != 0 ? 1 : 0;
    for (std::size_t i = is_bool ? 1 : 0; i < values.size(); ++i)
        seen[i] = values[i] + 0.0F;  // -0 becomes 0
}

}  // namespace

Seen::Seen(const check::Model& model, std::vector<Index> inputs)
    : model_(model),
      inputs_(std::move(inputs)),
      held_(inputs_.size()),
      seen_(inputs_.size()),
      hash_(hashed(model, inputs_)) {}

void Seen::add(const std::vector<execute::Sample>& samples) {
    for (std::size_t i = 0; i < inputs_.size(); ++i)
        see(model_.inputs[inputs_[i]], samples[inputs_[i]], held_[i], seen_[i]);
    hash_.add(seen_);
}

std::string Seen::inputs() const {
    std::string names;
    for (const Index index : inputs_) {
        const Input& input = model_.inputs[index];
        names += fmt::format("{}, {} x {}\n", name_of(input), static_cast<int>(input.type),
                             input.dimension);
    }
    return names;
}

/// Applies range, `hold` and `missing` as execute::Evaluator does.
void Seen::see(const Input& input, const execute::Sample& sample, Held& held,
               std::vector<float>& seen) const {
    seen.clear();
    if (is_there(input, sample)) {
        see_as(input, sample.values, seen);
        if (input.hold > 0) held = {seen, 0};
        return;
    }
    if (!held.values.empty() && held.age < input.hold)
        seen = held.values;
    else if (input.missing)
        seen.push_back(*input.missing ? 1 : 0);
    if (held.age < input.hold) ++held.age;
}

namespace {

using check::kNone;
using data::Channel;
using diag::Code;
using diag::Failure;
using execute::channel_of;

Index truth_of(const check::Model& model, Index predicate) {
    for (const check::Truth& truth : model.truths)
        if (truth.predicate == predicate) return truth.formula;
    return kNone;
}

std::string array_name(const check::Model& model, Index predicate) {
    return "truth." + model.predicates[predicate].name;
}

bool has_labels(const ReadOptions& options, const std::string& predicate) {
    return options.labels && options.labels->has(predicate);
}

/// Returns the channels to open: the inputs, then an array of labels for every predicate.
std::vector<Channel> channels_of(const Wanted& wanted, const std::vector<Index>& inputs,
                                 const std::vector<bool>& required) {
    std::vector<Channel> channels;
    for (const Index input : inputs) {
        channels.push_back(channel_of(wanted.model->inputs[input]));
        channels.back().optional = !required[input];
    }
    for (const Index predicate : wanted.predicates)
        channels.push_back({array_name(*wanted.model, predicate), Channel::Kind::boolean, 1, true});
    return channels;
}

/// Returns the inputs whose samples a monitor would see.
std::set<Index> seen_inputs(const Wanted& wanted) {
    std::set<Index> inputs(wanted.inputs.begin(), wanted.inputs.end());
    inputs.insert(wanted.optional.begin(), wanted.optional.end());
    return inputs;
}

/// Returns these and the inputs that truths read.
std::vector<Index> inputs_of(const Wanted& wanted, const TruthEvaluator& truths) {
    std::set<Index> inputs = seen_inputs(wanted);
    inputs.insert(truths.inputs().begin(), truths.inputs().end());
    return {inputs.begin(), inputs.end()};
}

std::vector<Index> formulas_of(const check::Model& model, const std::vector<Index>& predicates) {
    std::vector<Index> formulas;
    for (const Index predicate : predicates)
        if (truth_of(model, predicate) != kNone) formulas.push_back(truth_of(model, predicate));
    return formulas;
}

/// A trace, and its times in a last channel, which are compared with the rate of the spec.
class TimedTrace final : public data::Trace {
public:
    TimedTrace(std::unique_ptr<data::Trace> trace, std::size_t times, double step_seconds)
        : trace_(std::move(trace)), times_(times), step_seconds_(step_seconds) {}

    bool has(std::size_t channel) const override { return trace_->has(channel); }
    std::uint64_t length() const override { return trace_->length(); }

    diag::Result<bool> next(data::Sample& sample) override {
        auto more = trace_->next(sample);
        if (!more || !*more) return more;
        if (sample.present[times_] && std::isfinite(sample.values[times_][0]))
            if (auto failure = compare(sample.values[times_][0])) return *failure;
        ++step_;
        return more;
    }

private:
    struct Known {
        std::uint64_t step = 0;
        double time = 0;
    };

    std::optional<Failure> compare(double time) {
        constexpr double kMostBetween = 0.5;      // steps that neighbours are too near or too far
        constexpr double kRateTolerance = 0.005;  // as for videos: 29.97 frames a second are 30
        const Known here{step_, time};
        if (!last_) {
            last_ = first_ = here;
            return std::nullopt;
        }
        if (unit_ == 0)
            unit_ = unit_of((time - last_->time) / static_cast<double>(step_ - last_->step));
        const double between = steps_from(*last_, here);
        const double all = steps_from(first_, here);
        const auto rows = static_cast<double>(step_ - last_->step);
        const auto all_rows = static_cast<double>(step_ - first_.step);
        if (!(std::abs(between - rows) <= kMostBetween)) return out_of_step(here, *last_);
        if (!(std::abs(all - all_rows) <= kMostBetween + kRateTolerance * all_rows))
            return out_of_step(here, first_);
        last_ = here;
        return std::nullopt;
    }

    double steps_from(const Known& from, const Known& to) const {
        return (to.time - from.time) * unit_ / step_seconds_;
    }

    /// Returns the seconds of the unit in which this is nearest to one step.
    double unit_of(double difference) const {
        double best = 1;
        for (const double unit : {1e-3, 1e-6, 1e-9}) {
            const auto away = [&](double seconds) {
                return std::abs(std::log(std::abs(difference) * seconds / step_seconds_));
            };
            if (away(unit) < away(best)) best = unit;
        }
        return best;
    }

    Failure out_of_step(const Known& here, const Known& from) const {
        return {Code::video_out_of_step,
                fmt::format("has step {} {:.6g} s after step {} by its 'time', expected {:.6g} s: "
                            "the spec has {:.6g} steps a second",
                            here.step, (here.time - from.time) * unit_, from.step,
                            static_cast<double>(here.step - from.step) * step_seconds_,
                            1 / step_seconds_)};
    }

    std::unique_ptr<data::Trace> trace_;
    std::size_t times_;  ///< the channel
    double step_seconds_;
    double unit_ = 0;  ///< in seconds; 0: not known yet
    std::uint64_t step_ = 0;
    Known first_;
    std::optional<Known> last_;
};

/// Opens an episode with its labels, and with its times if the spec has a rate. The rows of data
/// sets have been compared with theirs.
diag::Result<std::unique_ptr<data::Trace>> open_timed(const std::string& path,
                                                      std::vector<Channel> channels,
                                                      const ReadOptions& options,
                                                      double step_seconds,
                                                      std::shared_ptr<IdentityCache>& identities) {
    const bool is_timed = step_seconds > 0 && !data::dataset_path(path);
    const std::size_t times = channels.size();
    if (is_timed) channels.push_back({std::string(data::kTimes), Channel::Kind::scalar, 1, true});
    auto trace = open_labelled(path, channels, options, &identities);
    if (!trace || !is_timed || !(*trace)->has(times)) return trace;
    return std::unique_ptr<data::Trace>(
        std::make_unique<TimedTrace>(std::move(*trace), times, step_seconds));
}

/// `absent`: the error of opening the episode with the array required.
Failure no_label(const check::Model& model, Index predicate, const Failure& absent) {
    return {Code::no_label,
            fmt::format("does not say when '{}' holds, and the spec has no truth for it: {}",
                        model.predicates[predicate].name, absent.message),
            absent.line, absent.column};
}

/// Returns whether the episode fails to name the encoder of its embeddings. Fails where that is
/// another than the spec's.
diag::Result<bool> read_encoders(const Wanted& wanted, const std::string& path,
                                 const recordings::NamesInFile& names) {
    const check::Model& model = *wanted.model;
    if (model.encoders.empty()) return false;
    const auto marks = embedded::read_marks(path);
    if (!marks) return marks.failure();
    for (const Index index : wanted.inputs) {
        const check::Input& input = model.inputs[index];
        const auto failure =
            check::other_encoder(model, input, recordings::name_in_file(input.name, names), *marks);
        if (failure) return *failure;
    }
    return is_unmarked(model, wanted.inputs, names, *marks);
}

}  // namespace

std::vector<Index> identity_inputs(const check::Model& model) {
    std::set<std::pair<std::string, Index>> calibrated;
    std::set<std::pair<std::string, Index>> all;
    for (const check::Predicate& predicate : model.predicates) {
        for (const Index input : predicate.inputs) {
            const std::pair<std::string, Index> named{model.inputs[input].name, input};
            all.insert(named);
            if (predicate.threshold.origin != check::ThresholdOrigin::literal)
                calibrated.insert(named);
        }
    }
    std::vector<Index> result;
    for (const auto& [name, input] : calibrated.empty() ? all : calibrated) result.push_back(input);
    return result;
}

bool is_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                 const recordings::NamesInFile& names, const embedded::Marks& marks) {
    return std::any_of(inputs.begin(), inputs.end(), [&](Index index) {
        const check::Input& input = model.inputs[index];
        return check::is_unmarked(input, recordings::name_in_file(input.name, names), marks);
    });
}

diag::Result<std::vector<Index>> labelled_in(const check::Model& model, const std::string& path,
                                             const ReadOptions& options) {
    std::vector<Index> asked;
    std::vector<Channel> channels;
    for (Index p = 0; p < model.predicates.size(); ++p) {
        if (model.predicates[p].name.empty() || truth_of(model, p) != kNone) continue;
        asked.push_back(p);
        channels.push_back({array_name(model, p), Channel::Kind::boolean, 1, true});
    }
    std::vector<Index> labelled;
    for (const check::Truth& truth : model.truths) labelled.push_back(truth.predicate);
    if (!asked.empty()) {
        for (const Index input : identity_inputs(model))  // they give the number of steps
            channels.push_back(channel_of(model.inputs[input]));
        const auto trace = open_labelled(path, channels, options);
        if (!trace) return trace.failure();
        for (std::size_t i = 0; i < asked.size(); ++i)
            if ((*trace)->has(i) || has_labels(options, model.predicates[asked[i]].name))
                labelled.push_back(asked[i]);
    }
    std::sort(labelled.begin(), labelled.end());
    return labelled;
}

diag::Result<Recording> Recording::open(const Wanted& wanted, const std::string& path,
                                        const ReadOptions& options, const Wrap& wrap) {
    const auto is_unmarked = read_encoders(wanted, path, options.names);
    if (!is_unmarked) return is_unmarked.failure();
    if (auto failure = recordings::check_rate(path, wanted.model->step_seconds)) return *failure;
    std::shared_ptr<IdentityCache> identities;
    const Opener file = [&](const std::vector<Channel>& channels) {
        return open_timed(path, channels, options, wanted.model->step_seconds, identities);
    };
    auto recording = open(wanted, wrap ? wrap(file) : file);
    if (!recording) return recording;
    recording->path_ = path;
    if (options.labels) {
        recording->group_ = options.labels->group_of(path);
        recording->outcome_ = options.labels->outcome_of(path);
    }
    recording->is_unmarked_ = *is_unmarked;
    if (identities) recording->known_ = identities->find(recording->seen_.inputs());
    recording->identities_ = std::move(identities);
    return recording;
}

diag::Result<Recording> Recording::open(const Wanted& wanted, const Opener& open) {
    const check::Model& model = *wanted.model;
    const TruthEvaluator all(model, formulas_of(model, wanted.predicates));
    const std::vector<Index> inputs = inputs_of(wanted, all);
    std::vector<bool> required(model.inputs.size());
    for (const Index input : wanted.inputs) required[input] = true;

    // Inputs that only truths read may be absent where arrays replace these truths.
    Recording result(wanted);
    auto trace = open(channels_of(wanted, inputs, required));
    if (!trace) return trace.failure();
    result.trace_ = std::move(*trace);
    result.sources_.resize(model.predicates.size());
    std::vector<Index> by_formula;
    for (std::size_t i = 0; i < wanted.predicates.size(); ++i) {
        const Index predicate = wanted.predicates[i];
        Source& source = result.sources_[predicate];
        source.channel = inputs.size() + i;
        source.from_array = result.trace_->has(source.channel);
        source.formula = source.from_array ? kNone : truth_of(model, predicate);
        if (!source.from_array && source.formula == kNone) {
            std::vector<Channel> channels = channels_of(wanted, inputs, required);
            channels[source.channel].optional = false;
            const auto required_too = open(channels);
            return no_label(model, predicate,
                            required_too ? Failure{Code::no_label, "the file has changed meanwhile"}
                                         : required_too.failure());
        }
        if (!source.from_array) by_formula.push_back(predicate);
    }
    result.truth_ = std::make_unique<TruthEvaluator>(model, formulas_of(model, by_formula));
    bool complete = true;
    for (const Index input : result.truth_->inputs()) {
        const auto channel = std::lower_bound(inputs.begin(), inputs.end(), input) - inputs.begin();
        complete = complete && result.trace_->has(static_cast<std::size_t>(channel));
        required[input] = true;
    }
    if (!complete) {  // opening with these required gives the message of the file's format
        trace = open(channels_of(wanted, inputs, required));
        if (!trace) return trace.failure();
    }
    result.channel_inputs_ = inputs;
    const std::set<Index> seen = seen_inputs(wanted);
    for (std::size_t c = 0; c < inputs.size(); ++c) {
        result.narrowed_.push_back(seen.contains(inputs[c]));
        result.is_complete_ &= !seen.contains(inputs[c]) || result.trace_->has(c);
    }
    result.freshness_.resize(inputs.size());
    result.samples_.resize(model.inputs.size());
    result.frame_.resize(model.inputs.size());
    if (auto failure = result.read_ahead(wanted, open)) return *failure;
    return result;
}

std::optional<Failure> Recording::read_ahead(const Wanted& wanted, const Opener& open) {
    Wanted labels = wanted;
    std::erase_if(labels.predicates,
                  [&](Index p) { return p >= wanted.within.size() || wanted.within[p] == 0; });
    if (labels.predicates.empty()) return std::nullopt;
    labels.within.clear();
    labels.identity.clear();
    labels.leaks = nullptr;
    auto recording = Recording::open(labels, open);
    if (!recording) return recording.failure();
    ahead_.resize(model_->predicates.size());
    for (;;) {
        const auto more = recording->next();
        if (!more) return more.failure();
        if (!*more) break;
        for (const Index p : labels.predicates) ahead_[p].push_back(recording->label(p));
    }
    for (const Index p : labels.predicates) open_near_changes(ahead_[p], wanted.within[p]);
    return std::nullopt;
}

diag::Result<bool> Recording::next() {
    auto more = trace_->next(sample_);
    if (more && !*more && frames_ == 0) return recordings::no_steps();
    if (more && !*more && identities_ && !known_) {
        known_ = std::make_shared<const Identity>(seen_.identity());
        identities_->add(seen_.inputs(), known_);
    }
    if (!more || !*more) return more;
    const auto narrowed = narrow();
    if (!narrowed) return narrowed;
    if (leaks_ != nullptr && !leak_) leak_ = leaks_->find(samples_, frames_);
    if (leaks_ != nullptr) leaks_->find_near(samples_, frames_, near_);
    if (!known_) seen_.add(samples_);
    for (std::size_t c = 0; c < channel_inputs_.size(); ++c) {
        std::vector<double>& recorded = frame_[channel_inputs_[c]];
        std::swap(recorded, sample_.values[c]);
        if (!sample_.present[c]) recorded.clear();
    }
    truth_->step(frame_);
    ++frames_;
    return true;
}

diag::Result<bool> Recording::narrow() {
    for (std::size_t c = 0; c < channel_inputs_.size(); ++c) {
        if (!narrowed_[c]) continue;
        const Index input = channel_inputs_[c];
        std::string why;
        auto sample = execute::narrow(model_->inputs[input], sample_.present[c], sample_.values[c],
                                      why, std::move(samples_[input]));
        if (!sample) return Failure{Code::trace_value, fmt::format("step {}: {}", frames_, why)};
        const check::Input& of = model_->inputs[input];
        if (of.stale_after > 0 && is_there(of, *sample) &&
            !freshness_[c].accepts(of, sample->values))
            *sample = {.is_stale = true};
        samples_[input] = std::move(*sample);
    }
    return true;
}

Label Recording::label(Index predicate) const {
    if (!ahead_.empty() && frames_ <= ahead_[predicate].size())
        return ahead_[predicate][frames_ - 1];
    return recorded_label(predicate);
}

Label Recording::recorded_label(Index predicate) const {
    const Source& source = sources_[predicate];
    if (!source.from_array) return (*truth_)[source.formula];
    const double value = sample_.values[source.channel][0];
    if (!sample_.present[source.channel] || value != value) return Label::unknown;
    return value != 0 ? Label::yes : Label::no;
}

// ---- points of the last frames ------------------------------------------------------------------

RecentFrames::RecentFrames(const check::Model& model, const std::vector<Index>& points)
    : model_(model) {
    std::set<Index> inputs;
    for (const Index point : points) {
        inputs.insert(model.points[point].inputs.begin(), model.points[point].inputs.end());
        most_ = std::max<std::size_t>(most_, check::longest_delay(model, point));
    }
    inputs_.assign(inputs.begin(), inputs.end());
}

void RecentFrames::push(const std::vector<execute::Sample>& samples) {
    last_ = &samples;
    if (most_ == 0) return;
    std::vector<execute::Sample> frame;
    if (frames_.size() > most_) {
        frame = std::move(frames_.back());  // its memory is used again
        frames_.pop_back();
    }
    frame.resize(samples.size());
    for (const Index input : inputs_) frame[input] = samples[input];
    frames_.push_front(std::move(frame));
}

bool RecentFrames::read(Index point, std::vector<float>& values) const {
    values.clear();
    return append(point, 0, values);
}

/// Returns nothing before the first frame.
const std::vector<execute::Sample>* RecentFrames::at(std::size_t ago) const {
    if (ago == 0) return last_;
    return ago < frames_.size() ? &frames_[ago] : nullptr;
}

bool RecentFrames::append(Index index, std::size_t ago, std::vector<float>& values) const {
    const check::Point& point = model_.points[index];
    if (point.is_delayed()) return append(point.inner, ago + point.steps, values);
    if (point.is_joined())
        return std::all_of(point.parts.begin(), point.parts.end(),
                           [&](Index part) { return append(part, ago, values); });
    if (point.is_sum()) return append_sum(point, ago, values);
    const std::vector<execute::Sample>* const frame = at(ago);
    if (frame == nullptr) return false;
    for (const Index input : point.inputs) {
        const execute::Sample& sample = (*frame)[input];
        if (!is_there(model_.inputs[input], sample)) return false;
        values.insert(values.end(), sample.values.begin(), sample.values.end());
    }
    return true;
}

/// Adds as a monitor does.
bool RecentFrames::append_sum(const check::Point& point, std::size_t ago,
                              std::vector<float>& values) const {
    std::vector<float> sum(point.dimension);
    for (std::size_t i = 0; i < point.parts.size(); ++i) {
        std::vector<float> part;
        if (!append(point.parts[i], ago, part)) return false;
        etlmon::detail::add_term({point.factors[i], part.data()}, point.dimension, sum.data());
    }
    values.insert(values.end(), sum.begin(), sum.end());
    return etlmon::finite(sum.data(), sum.size());
}

// ---- monitors beside a recording ----------------------------------------------------------------

Follower::Follower(const plan::Plan& plan, const GroundTruth* truth)
    : plan_(plan), truth_(truth), places_(plan.model->monitors.size()), evaluator_(plan) {
    for (std::size_t m = 0; m < plan.monitors.size(); ++m) places_[plan.monitors[m].index] = m;
    if (truth != nullptr) labelled_ = labelled_predicates(*truth);
}

void Follower::step(const Frames& recording) {
    finished_ = false;
    if (truth_ == nullptr) {
        verdicts_ = &evaluator_.step(recording.samples());
        return;
    }
    samples_.assign(recording.samples().begin(), recording.samples().end());
    samples_.resize(truth_->model.inputs.size());
    for (const Index predicate : labelled_)
        samples_[truth_->inputs[predicate]] = sample_of(recording.label(predicate));
    verdicts_ = &evaluator_.step(samples_);
}

void Follower::finish() {
    finished_ = true;
    verdicts_ = &evaluator_.finish();
}

bool Follower::reports(Index monitor) const {
    return verdict(monitor).decided() && (!finished_ || plan_.model->monitors[monitor].sliding);
}

Wanted wanted(const check::Model& model, const std::vector<const plan::Plan*>& plans,
              std::vector<Index> predicates, const Leaks& leaks) {
    std::vector<Index> identity = identity_inputs(model);
    std::set<Index> inputs(identity.begin(), identity.end());
    for (const plan::Plan* plan : plans)
        for (const Index input : plan->inputs)
            if (input < model.inputs.size()) inputs.insert(input);  // the others are labels
    return {
        &model, {inputs.begin(), inputs.end()}, std::move(predicates), std::move(identity), &leaks};
}

diag::Result<bool> replay(Frames& recording, const std::vector<Follower*>& followers,
                          const AfterStep& frame, const AfterStep& rest) {
    for (Follower* follower : followers) follower->reset();
    for (;;) {
        const auto more = recording.next();
        if (!more) return more.failure();
        if (!*more) break;
        for (Follower* follower : followers) follower->step(recording);
        if (!frame()) return false;
    }
    std::uint32_t left = 0;
    for (const Follower* follower : followers)
        for (const plan::Monitor& monitor : follower->plan().monitors)
            left = std::max(left, monitor.horizon);
    for (std::uint32_t position = 0; rest && position < left; ++position) {
        for (Follower* follower : followers) follower->finish();
        if (!rest()) return false;
    }
    return true;
}

}  // namespace etlc::episodes
