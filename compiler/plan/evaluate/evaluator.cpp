#include "plan/evaluate/evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/predicate.hpp"
#include "etlmon/temporal/shift.hpp"
#include "etlmon/temporal/window.hpp"
#include "etlmon/views.hpp"
#include "plan/program/predicate_values.hpp"

namespace etlc::plan {

using etlmon::kBottom;
using etlmon::kFalse;
using etlmon::kTop;
using etlmon::kTrue;

namespace {

constexpr Value kAnything{kBottom, kTop};

std::uint32_t saturating_increment(std::uint32_t x) {
    return x == std::numeric_limits<std::uint32_t>::max() ? x : x + 1;
}

}  // namespace

Evaluator::Evaluator(const Plan& plan) : plan_(plan), model_(*plan.model) {
    prepare_distances();
    inputs_.resize(model_.inputs.size());
    held_.resize(model_.inputs.size());
    freshness_.resize(model_.inputs.size());
    for (const Index i : plan.inputs) {
        held_[i].values.reserve(model_.inputs[i].dimension);
        if (model_.inputs[i].stale_after > 0) freshness_[i].reserve(model_.inputs[i].dimension);
    }
    distances_.resize(model_.distances.size());
    enclosed_.resize(model_.distances.size());
    for (const Index past : plan.pasts) past_states_.emplace_back(model_.pasts[past]);
    pasts_.resize(model_.pasts.size());
    past_operands_.resize(model_.pasts.size());
    measured_.resize(model_.predicates.size());
    for (const check::Predicate& predicate : model_.predicates)
        thresholds_.push_back(predicate.threshold.value);
    predicate_values_.resize(model_.predicates.size(), kAnything);
    flags_.resize(model_.inputs.size(), kAnything);
    streams_.resize(plan.streams.size());
    stream_states_.resize(plan.streams.size());
    for (Slot slot = 0; slot < plan.streams.size(); ++slot)
        stream_states_[slot].members = members_of(plan.streams[slot]);
    readings_.resize(plan.readings.size());
    reading_states_.resize(plan.readings.size());
    for (std::size_t i = 0; i < plan.readings.size(); ++i)
        prepare_reading(plan.readings[i], reading_states_[i]);
    verdicts_.resize(plan.monitors.size());
    starts_.resize(plan.monitors.size());
    restarts_.resize(plan.monitors.size());
    reset();
}

void Evaluator::reset() {
    for (Held& held : held_) {
        held.values.clear();
        held.age = 0;
    }
    for (Freshness& freshness : freshness_) freshness.reset();
    for (EarlierSamples& earlier : earlier_) earlier.reset();
    counts_.assign(model_.inputs.size(), {});
    for (StreamState& state : stream_states_) reset_stream(state);
    for (std::size_t i = 0; i < plan_.readings.size(); ++i)
        reset_reading(plan_.readings[i], reading_states_[i]);
    for (PastState& past : past_states_) past.reset();
    std::fill(pasts_.begin(), pasts_.end(), etlmon::kMissing);
    std::fill(measured_.begin(), measured_.end(), etlmon::Measured{etlmon::kMissing, 0});
    std::fill(verdicts_.begin(), verdicts_.end(), etlmon::Verdict{});
    lets_.assign(plan_.lets.size(), etlmon::Verdict{});
    std::fill(starts_.begin(), starts_.end(), 0);
    std::fill(restarts_.begin(), restarts_.end(), false);
    steps_ = 0;
    started_ = false;
    finished_ = 0;
    missing_steps_ = 0;
}

const std::vector<etlmon::Verdict>& Evaluator::step(const std::vector<Sample>& samples) {
    if (started_) ++steps_;
    started_ = true;
    restart_those_due();
    take_inputs(samples);
    measure_distances();
    take_pasts();
    measure_predicates();
    keep_points();
    advance_streams();
    advance_readings();
    judge();
    for (std::size_t m = 0; m < plan_.monitors.size(); ++m)
        if (plan_.monitors[m].restarts == check::Restarts::when_final && verdicts_[m].final())
            restart(m);
    return verdicts_;
}

void Evaluator::restart(std::size_t monitor) {
    restarts_[monitor] = true;
}

std::uint64_t Evaluator::position(std::size_t monitor) const {
    const Monitor& m = plan_.monitors[monitor];
    return m.sliding ? steps_ - m.horizon : starts_[monitor];
}

/// Restarts what belongs to monitors restarted before this step.
void Evaluator::restart_those_due() {
    const auto restarts = [&](std::uint32_t begins_with) {
        return begins_with != kNone && restarts_[begins_with];
    };
    for (Slot slot = 0; slot < plan_.streams.size(); ++slot)
        if (restarts(plan_.streams[slot].begins_with)) reset_stream(stream_states_[slot]);
    for (std::size_t i = 0; i < plan_.readings.size(); ++i)
        if (restarts(plan_.readings[i].begins_with))
            reset_reading(plan_.readings[i], reading_states_[i]);
    for (std::size_t m = 0; m < plan_.monitors.size(); ++m)
        if (restarts_[m]) starts_[m] = steps_;
    std::fill(restarts_.begin(), restarts_.end(), false);
}

const std::vector<etlmon::Verdict>& Evaluator::finish() {
    if (started_) ++steps_;
    started_ = true;
    finished_ = saturating_increment(finished_);
    advance_streams();
    judge();
    return verdicts_;
}

void Evaluator::observe(Index predicate, float distance, bool truth) {
    if (truth)
        thresholds_[predicate] =
            observed(model_.predicates[predicate], thresholds_[predicate], distance);
}

// ---- inputs, distances, predicates

namespace {

bool is_there(const Sample& sample) {
    return sample.present && !sample.values.empty() &&
           etlmon::finite(sample.values.data(), sample.values.size());
}

Value flag_value(const check::Input& input, const float* sample) {
    if (sample == nullptr) return missing_value(input);
    return *sample != 0 ? kTrue : kFalse;
}

bool in_range(const check::Input& input, const Sample& sample) {
    if (input.type != check::InputType::scalar) return true;
    return input.range.low <= sample.values[0] && sample.values[0] <= input.range.high;
}

}  // namespace

/// `stale after N`: a sample that comes more often in a row counts as missing. `hold N`: the last
/// present sample replaces at most N missing ones in a row.
void Evaluator::take_inputs(const std::vector<Sample>& samples) {
    for (Index i : plan_.inputs) {
        const check::Input& input = model_.inputs[i];
        Held& held = held_[i];
        const bool there = is_there(samples[i]);
        const bool usable = there && in_range(input, samples[i]);
        if (usable && freshness_[i].accepts(input, samples[i].values)) {
            held.values = samples[i].values;
            held.age = 0;
            inputs_[i] = held.values.data();
        } else {
            const bool stands_in = !held.values.empty() && held.age < input.hold;
            ++(usable || samples[i].is_stale ? counts_[i].stale
               : there                       ? counts_[i].out_of_range
                                             : counts_[i].missing);
            if (stands_in) ++counts_[i].held;
            held.age = saturating_increment(held.age);
            inputs_[i] = stands_in ? held.values.data() : nullptr;
        }
        if (input.type == check::InputType::boolean) flags_[i] = flag_value(input, inputs_[i]);
    }
}

bool Evaluator::is_measured(const check::Predicate& predicate) const {
    const std::vector<Index> distances = predicate.distances();
    return std::none_of(distances.begin(), distances.end(),
                        [&](Index d) { return std::isnan(distances_[d].delta); });
}

void Evaluator::measure_predicates() {
    bool missing = false;
    for (const Stream& stream : plan_.streams)
        if (stream.op == StreamOp::flag) missing |= inputs_[stream.index] == nullptr;
    for (Index p : plan_.predicates) {
        const check::Predicate& predicate = model_.predicates[p];
        etlmon::Measured measured{etlmon::kMissing, 0};
        if (predicate.plain_distance()) measured = distances_[predicate.expression.index];
        const bool is_contrast = !contrast_cuts_[p].empty() && is_measured(predicate);
        const etlmon::Enclosed contrast =
            is_contrast ? measure_contrast(predicate) : etlmon::Enclosed{};
        if (is_contrast)
            measured.delta = contrast.measured.delta;
        else if (!predicate.plain_distance())
            measured.delta = expression(predicate.expression);
        measured_[p] = measured;
        predicate_values_[p] = value_of(predicate, measured.delta, thresholds_[p], plan_.values);
        if (predicate.plain_distance() && plan_.values != check::Values::boolean)
            predicate_values_[p] =
                value_of(predicate, enclosed_[predicate.expression.index], thresholds_[p]);
        if (is_contrast && plan_.values == check::Values::robustness)
            predicate_values_[p] = value_of(predicate, contrast, thresholds_[p]);
        if (replacement_ && !std::isnan(measured.delta)) predicate_values_[p] = replacement_(p);
        missing |= std::isnan(measured.delta);
    }
    if (missing) missing_steps_ = saturating_increment(missing_steps_);
}

// ---- streams

/// Returns an operand, or `where_none` if its position is before the trace or after its end.
Value Evaluator::operand(const Stream& stream, std::size_t i, Value where_none) const {
    return exists(stream.operand_lag) ? streams_[stream.operands[i]] : where_none;
}

void Evaluator::advance_streams() {
    for (Slot slot = 0; slot < plan_.streams.size(); ++slot)
        streams_[slot] = advance(plan_.streams[slot], stream_states_[slot]);
}

namespace {

Value combined(bool max, Value a, Value b) {
    return max ? max_of(a, b) : min_of(a, b);
}

template <class Monoid, class Element>
Element push(std::vector<Element>& elements, std::uint32_t& cursor, std::uint32_t length,
             Element element) {
    return etlmon::window_push<Monoid>(elements.data(), cursor, length, element);
}

}  // namespace

Value Evaluator::advance_window(const Stream& stream, StreamState& state) const {
    const std::uint32_t n = stream.length;
    const Value none = neutral(stream.max);
    if (stream.op == StreamOp::window) {
        const Value value = operand(stream, 0, none);
        return stream.max ? push<etlmon::Greatest<Value>>(state.values, state.cursor, n, value)
                          : push<etlmon::Least<Value>>(state.values, state.cursor, n, value);
    }
    if (stream.op == StreamOp::window_handover) {
        const auto pushed = [&](auto monoid) {
            using Monoid = decltype(monoid);
            return push<Monoid>(state.flanks, state.cursor, n,
                                Monoid::at(operand(stream, 0, none), operand(stream, 1, none)))
                .value;
        };
        return stream.max ? pushed(etlmon::Handover<Value>()) : pushed(etlmon::Covered<Value>());
    }
    const etlmon::Span<Value> pair{operand(stream, 1, none),
                                   operand(stream, 0, neutral(!stream.max))};
    const auto pushed = [&](auto seeking, auto guarding) {
        return stream.max ? push<decltype(seeking)>(state.pairs, state.cursor, n, pair).value
                          : push<decltype(guarding)>(state.pairs, state.cursor, n, pair).value;
    };
    return stream.op == StreamOp::window_since
               ? pushed(etlmon::Since<Value>(), etlmon::Trigger<Value>())
               : pushed(etlmon::Until<Value>(), etlmon::Release<Value>());
}

namespace {

/// Returns the n-th greatest of the sorted values, or the n-th least, after an exchange of one.
Key exchanged(std::vector<Key>& sorted, Key leaves, Key enters, bool max, std::uint32_t n) {
    sorted.erase(std::lower_bound(sorted.begin(), sorted.end(), leaves));
    sorted.insert(std::upper_bound(sorted.begin(), sorted.end(), enters), enters);
    if (n > sorted.size()) return max ? kBottom : kTop;
    return max ? sorted[sorted.size() - n] : sorted[n - 1];
}

}  // namespace

Value Evaluator::advance_count(const Stream& stream, StreamState& state) const {
    const Value enters = operand(stream, 0, neutral(stream.max));
    const Value leaves =
        etlmon::delay_push(state.values.data(), state.cursor, stream.length, enters);
    return {exchanged(state.lows, leaves.low, enters.low, stream.max, stream.index),
            exchanged(state.highs, leaves.high, enters.high, stream.max, stream.index)};
}

Value Evaluator::advance(const Stream& stream, StreamState& state) const {
    const bool max = stream.max;
    const auto at = [&](std::size_t i) { return streams_[stream.operands[i]]; };
    const auto delayed = [&](std::uint32_t length, Value value) {
        return etlmon::delay_push(state.values.data(), state.cursor, length, value);
    };
    switch (stream.op) {
        case StreamOp::constant: return stream.value;
        case StreamOp::predicate: return predicate_values_[stream.index];
        case StreamOp::flag: return flags_[stream.index];
        case StreamOp::negation: return negate(at(0));
        case StreamOp::combination: {
            Value value = at(0);
            for (Slot slot : stream.operands) value = combined(max, value, streams_[slot]);
            return value;
        }
        case StreamOp::within: {
            const std::uint64_t position = steps_since(stream.begins_with);
            const auto [low, high] = stream.interval;
            const bool inside = low <= position && (high == kUnbounded || position <= high);
            return inside ? at(0) : stream.value;
        }
        case StreamOp::delay: return delayed(stream.length, at(0));
        case StreamOp::shift: return delayed(stream.length, operand(stream, 0, stream.value));
        case StreamOp::running:
            return state.values[0] =
                       combined(max, state.values[0], operand(stream, 0, neutral(max)));
        case StreamOp::since:
            return state.values[0] =
                       combined(max, operand(stream, 1, neutral(max)),
                                combined(!max, state.values[0], operand(stream, 0, neutral(!max))));
        case StreamOp::widening:
            return combined(max, delayed(stream.length - stream.from_length, at(0)), at(0));
        case StreamOp::window:
        case StreamOp::window_since:
        case StreamOp::window_until:
        case StreamOp::window_handover: return advance_window(stream, state);
        case StreamOp::window_count: return advance_count(stream, state);
    }
    return kAnything;
}

void Evaluator::reset_stream(StreamState& state) {
    for (const Member& member : state.members) reset_member(member, state);
}

void Evaluator::reset_member(const Member& member, StreamState& state) {
    state.cursor = 0;
    switch (member.kind) {
        case Member::Kind::value: state.values.assign(1, member.first); break;
        case Member::Kind::delay: state.values.assign(member.length, member.first); break;
        case Member::Kind::window:
            state.values.assign(etlmon::window_elements(member.length), neutral(member.max));
            break;
        case Member::Kind::since_window:
        case Member::Kind::until_window:
            state.pairs.assign(etlmon::window_elements(member.length),
                               {neutral(member.max), neutral(!member.max)});
            break;
        case Member::Kind::handover_window:
            state.flanks.assign(etlmon::window_elements(member.length),
                                {neutral(member.max), neutral(!member.max), neutral(!member.max)});
            break;
        case Member::Kind::count_window:
            state.values.assign(member.length, neutral(member.max));
            state.lows.assign(member.length, neutral(member.max).low);
            state.highs = state.lows;
            break;
        case Member::Kind::widening:
            state.values.assign(member.length - member.from_length, neutral(member.max));
            break;
        default: break;  // these belong to readings
    }
}

void Evaluator::judge() {
    for (std::size_t m = 0; m < plan_.monitors.size(); ++m) {
        const Monitor& monitor = plan_.monitors[m];
        if (monitor.sliding && !exists(monitor.horizon)) {
            verdicts_[m] = etlmon::Verdict{};
        } else if (monitor.sliding) {
            const Value value = streams_[monitor.stream];
            verdicts_[m] = etlmon::sliding_verdict(
                monitor.shifted ? etlmon::shifted(value, monitor.shift) : value);
        } else if (finished_ == 0) {
            const etlmon::Reading& reading = readings_[monitor.reading];
            verdicts_[m] = etlmon::prefix_verdict(
                monitor.shifted ? etlmon::shifted(reading, monitor.shift) : reading);
        }
    }
    for (std::size_t l = 0; finished_ == 0 && l < plan_.lets.size(); ++l)
        lets_[l] = etlmon::sliding_verdict(streams_[plan_.lets[l].stream]);
}

}  // namespace etlc::plan
