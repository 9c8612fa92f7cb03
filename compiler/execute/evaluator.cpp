#include "execute/evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/predicate.hpp"
#include "etlmon/temporal/shift.hpp"
#include "etlmon/temporal/window.hpp"
#include "etlmon/views.hpp"
#include "plan/program/value_type.hpp"

namespace etlc::execute {

using namespace plan;

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

Evaluator::Evaluator(const Plan& plan) : Evaluator(plan, std::make_shared<const Tables>(plan)) {}

Evaluator::Evaluator(const Plan& plan, std::shared_ptr<const Tables> tables)
    : plan_(plan),
      model_(*plan.model),
      tables_(std::move(tables)),
      own_(std::make_unique<State>(plan, tables_->shape)),
      state_(own_.get()) {
    make_room();
}

void Evaluator::make_room() {
    views_.resize(model_.inputs.size());
    inputs_.resize(model_.inputs.size());
    taken_.resize(model_.inputs.size());
    for (const Index i : plan_.inputs) taken_[i].reserve(model_.inputs[i].dimension);
    points_.resize(model_.points.size());
    point_at_.resize(model_.points.size());
    for (Index p = 0; p < model_.points.size(); ++p)
        if (model_.points[p].kind != check::Point::Kind::embedding)
            points_[p].resize(model_.points[p].dimension);
    centred_.resize(tables_->centred);
    near_ = tables_->near;
    near_values_.reserve(tables_->near_values);
    distances_.resize(model_.distances.size());
    enclosed_.resize(model_.distances.size());
    pasts_.resize(model_.pasts.size(), etlmon::kMissing);
    past_operands_.resize(model_.pasts.size());
    scratch_.resize(tables_->scratch);
    streams_.resize(plan_.streams.size());
    readings_.resize(plan_.readings.size());
}

void Evaluator::use(State& state) {
    state_ = &state;
    std::fill(inputs_.begin(), inputs_.end(), nullptr);
    std::fill(point_at_.begin(), point_at_.end(), nullptr);
}

void Evaluator::reset() {
    state_->reset(plan_, tables_->shape);
}

const std::vector<etlmon::Verdict>& Evaluator::step(const std::vector<Sample>& samples) {
    for (const Index i : plan_.inputs) {
        const bool there = samples[i].present && !samples[i].values.empty();
        views_[i] = {there ? samples[i].values.data() : nullptr, samples[i].is_stale};
    }
    return step(views_.data(), false);
}

const std::vector<etlmon::Verdict>& Evaluator::step(const SampleView* samples, bool borrow) {
    if (state_->started) ++state_->steps;
    state_->started = true;
    restart_those_due();
    take_inputs(samples, borrow);
    measure_distances();
    take_pasts();
    measure_predicates();
    keep_points();
    advance_streams();
    advance_readings();
    judge();
    see_scores();
    for (std::size_t m = 0; m < plan_.monitors.size(); ++m)
        if (plan_.monitors[m].restarts == check::Restarts::when_final &&
            state_->verdicts[m].final())
            restart(m);
    return state_->verdicts;
}

void Evaluator::restart(std::size_t monitor) {
    state_->restarts[monitor] = true;
}

std::uint64_t Evaluator::position(std::size_t monitor) const {
    const Monitor& m = plan_.monitors[monitor];
    return m.sliding ? state_->steps - m.horizon : state_->starts[monitor];
}

/// Restarts what belongs to monitors restarted before this step.
void Evaluator::restart_those_due() {
    const std::vector<bool>& due = state_->restarts;
    if (std::find(due.begin(), due.end(), true) == due.end()) return;
    const auto restarts = [&](std::uint32_t begins_with) {
        return begins_with != kNone && state_->restarts[begins_with];
    };
    for (Slot slot = 0; slot < plan_.streams.size(); ++slot)
        if (restarts(plan_.streams[slot].begins_with)) state_->reset_stream(slot, tables_->shape);
    for (std::size_t i = 0; i < plan_.readings.size(); ++i)
        if (restarts(plan_.readings[i].begins_with))
            state_->reset_reading(i, plan_, tables_->shape);
    for (std::size_t m = 0; m < plan_.monitors.size(); ++m)
        if (state_->restarts[m]) state_->starts[m] = state_->steps;
    std::fill(state_->restarts.begin(), state_->restarts.end(), false);
}

const std::vector<etlmon::Verdict>& Evaluator::finish() {
    if (state_->started) ++state_->steps;
    state_->started = true;
    state_->finished = saturating_increment(state_->finished);
    advance_streams();
    judge();
    return state_->verdicts;
}

/// The score of a step is the distance, or how little the monitor may still reach.
void Evaluator::see_scores() {
    for (std::size_t i = 0; i < plan_.drifts.size(); ++i) {
        const check::Drift& drift = model_.drifts[plan_.drifts[i]];
        if (drift.predicate == kNone) {
            for (std::size_t m = 0; m < plan_.monitors.size(); ++m)
                if (plan_.monitors[m].index == drift.monitor)
                    state_->drifts[i].see(-state_->verdicts[m].upper);
            continue;
        }
        const float delta = distance(drift.predicate);
        state_->drifts[i].see(model_.predicates[drift.predicate].upper_bound() ? delta : -delta);
    }
}

void Evaluator::end_episode() {
    for (std::size_t i = 0; i < plan_.drifts.size(); ++i) state_->drifts[i].end(drift_cells(i));
}

void Evaluator::observe(Index predicate, float distance, bool truth) {
    if (truth)
        state_->thresholds[predicate] =
            observed(model_.predicates[predicate], state_->thresholds[predicate], distance);
}

// ---- inputs, distances, predicates

namespace {

Value flag_value(const check::Input& input, const float* sample) {
    if (sample == nullptr) return missing_value(input);
    return *sample != 0 ? kTrue : kFalse;
}

bool in_range(const check::Input& input, const float* elements) {
    if (input.type != check::InputType::scalar) return true;
    return input.range.low <= *elements && *elements <= input.range.high;
}

}  // namespace

/// `stale after N`: a sample that comes more often in a row counts as missing. `hold N`: the last
/// present sample replaces at most N missing ones in a row.
void Evaluator::take_inputs(const SampleView* samples, bool borrow) {
    for (const Index i : plan_.inputs) {
        const check::Input& input = model_.inputs[i];
        State::Held& held = state_->held[i];
        const float* const elements = samples[i].elements;
        const bool there = elements != nullptr && all_finite(elements, input.dimension);
        const bool usable = there && in_range(input, elements);
        if (usable && state_->freshness[i].accepts(input, {elements, input.dimension})) {
            inputs_[i] = keep(i, elements, borrow);
        } else {
            const bool stands_in = !held.values.empty() && held.age < input.hold;
            SampleCounts& counts = state_->counts[i];
            ++(usable || samples[i].is_stale ? counts.stale
               : there                       ? counts.out_of_range
                                             : counts.missing);
            if (stands_in) ++counts.held;
            held.age = saturating_increment(held.age);
            inputs_[i] = stands_in ? held.values.data() : nullptr;
        }
        if (input.type == check::InputType::boolean)
            state_->flags[i] = flag_value(input, inputs_[i]);
    }
}

/// Returns the elements of a sample in memory that lasts as long as it is needed.
const float* Evaluator::keep(Index index, const float* elements, bool borrow) {
    const check::Input& input = model_.inputs[index];
    if (borrow && input.hold == 0) return elements;
    State::Held& held = state_->held[index];
    std::vector<float>& to = input.hold == 0 ? taken_[index] : held.values;
    to.assign(elements, elements + input.dimension);
    held.age = 0;
    return to.data();
}

bool Evaluator::is_measured(const check::Predicate& predicate) const {
    const std::vector<Index> distances = predicate.distances();
    return std::none_of(distances.begin(), distances.end(),
                        [&](Index d) { return std::isnan(distances_[d].delta); });
}

void Evaluator::measure_predicates() {
    bool missing = false;
    for (const Index flag : tables_->flags) missing |= inputs_[flag] == nullptr;
    for (Index p : plan_.predicates) {
        const check::Predicate& predicate = model_.predicates[p];
        etlmon::Measured measured{etlmon::kMissing, 0};
        if (predicate.plain_distance()) measured = distances_[predicate.expression.index];
        const bool is_contrast = !tables_->contrast_cuts[p].empty() && is_measured(predicate);
        const etlmon::Enclosed contrast =
            is_contrast ? measure_contrast(predicate) : etlmon::Enclosed{};
        if (is_contrast)
            measured.delta = contrast.measured.delta;
        else if (!predicate.plain_distance())
            measured.delta = expression(predicate.expression);
        state_->measured[p] = measured;
        state_->predicate_values[p] =
            value_of(predicate, measured.delta, state_->thresholds[p], plan_.values);
        if (predicate.plain_distance() && plan_.values != check::Values::boolean)
            state_->predicate_values[p] =
                value_of(predicate, enclosed_[predicate.expression.index], state_->thresholds[p]);
        if (is_contrast && plan_.values == check::Values::robustness)
            state_->predicate_values[p] = value_of(predicate, contrast, state_->thresholds[p]);
        if (replacement_ && !std::isnan(measured.delta))
            state_->predicate_values[p] = replacement_(p);
        missing |= std::isnan(measured.delta);
    }
    if (missing) state_->missing_steps = saturating_increment(state_->missing_steps);
}

// ---- streams

/// Returns an operand, or `where_none` if its position is before the trace or after its end.
Value Evaluator::operand(const Stream& stream, std::size_t i, Value where_none) const {
    return exists(stream.operand_lag) ? streams_[stream.operands[i]] : where_none;
}

void Evaluator::advance_streams() {
    for (Slot slot = 0; slot < plan_.streams.size(); ++slot)
        streams_[slot] = advance(plan_.streams[slot], state_->streams[slot]);
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

Value Evaluator::advance_window(const Stream& stream, State::OfStream& state) const {
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

Value Evaluator::advance_count(const Stream& stream, State::OfStream& state) const {
    const Value enters = operand(stream, 0, neutral(stream.max));
    const Value leaves =
        etlmon::delay_push(state.values.data(), state.cursor, stream.length, enters);
    return {exchanged(state.lows, leaves.low, enters.low, stream.max, stream.index),
            exchanged(state.highs, leaves.high, enters.high, stream.max, stream.index)};
}

Value Evaluator::advance(const Stream& stream, State::OfStream& state) const {
    const bool max = stream.max;
    const auto at = [&](std::size_t i) { return streams_[stream.operands[i]]; };
    const auto delayed = [&](std::uint32_t length, Value value) {
        return etlmon::delay_push(state.values.data(), state.cursor, length, value);
    };
    switch (stream.op) {
        case StreamOp::constant: return stream.value;
        case StreamOp::predicate: return state_->predicate_values[stream.index];
        case StreamOp::flag: return state_->flags[stream.index];
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

namespace {

/// Returns a value or reading less the shifts of a monitor that is calibrated as a whole.
template <class Shifted>
Shifted shifted(const Monitor& monitor, const Shifted& value) {
    if (!monitor.shifted) return value;
    return monitor.inner_shift ? etlmon::shifted(value, *monitor.inner_shift, monitor.shift)
                               : etlmon::shifted(value, monitor.shift);
}

}  // namespace

void Evaluator::judge() {
    for (std::size_t m = 0; m < plan_.monitors.size(); ++m) {
        const Monitor& monitor = plan_.monitors[m];
        if (monitor.sliding && !exists(monitor.horizon)) {
            state_->verdicts[m] = etlmon::Verdict{};
        } else if (monitor.sliding) {
            const Value value = streams_[monitor.stream];
            state_->verdicts[m] = etlmon::sliding_verdict(shifted(monitor, value));
        } else if (state_->finished == 0) {
            const std::uint64_t position =
                steps_since(monitor.begins_with(static_cast<std::uint32_t>(m)));
            const bool complete = monitor.ahead != kUnbounded && position >= monitor.ahead;
            state_->verdicts[m] =
                etlmon::prefix_verdict(shifted(monitor, readings_[monitor.reading]), complete);
        }
    }
    for (std::size_t l = 0; state_->finished == 0 && l < plan_.lets.size(); ++l)
        state_->lets[l] = etlmon::sliding_verdict(streams_[plan_.lets[l].stream]);
}

using etlmon::kFalse;
using etlmon::kTop;
using etlmon::kTrue;

void Evaluator::advance_readings() {
    for (std::size_t i = 0; i < plan_.readings.size(); ++i)
        readings_[i] = advance(plan_.readings[i], state_->readings[i]);
}

etlmon::Reading Evaluator::advance(const Reading& reading, State::OfReading& state) const {
    const std::uint64_t position = steps_since(reading.begins_with);
    switch (reading.kind) {
        case Reading::Kind::straight: return run(reading.straight, state, position);
        case Reading::Kind::table: return run(reading.table, state);
        case Reading::Kind::pending: return state.pending->advance(position, streams_);
        case Reading::Kind::combination: break;
    }
    etlmon::Reading result = readings_[reading.operands[0]];
    for (std::uint32_t operand : reading.operands) {
        const etlmon::Reading& other = readings_[operand];
        result = reading.max ? max_of(result, other) : min_of(result, other);
    }
    return result;
}

Value Evaluator::value(const Term& term, const State::OfReading& state,
                       std::uint64_t position) const {
    const auto operand = [&](std::size_t i) { return value(term.operands[i], state, position); };
    switch (term.kind) {
        case Term::Kind::constant: return term.value;
        case Term::Kind::stream: return streams_[term.index];
        case Term::Kind::reg: return state.registers[term.index];
        case Term::Kind::local: return state.next[term.index];
        case Term::Kind::before: return operand(position < term.index ? 0 : 1);
        case Term::Kind::extreme: break;
    }
    Value result = operand(0);
    for (std::size_t i = 1; i < term.operands.size(); ++i)
        result = term.max ? max_of(result, operand(i)) : min_of(result, operand(i));
    return result;
}

etlmon::Reading Evaluator::run(const Straight& code, State::OfReading& state,
                               std::uint64_t position) const {
    for (const Assignment& assignment : code.assignments) {
        const auto [low, high] = assignment.positions;
        if (position < low || (high != kUnbounded && position > high)) continue;
        const bool is_register = assignment.target == Term::Kind::reg;
        (is_register ? state.registers : state.next)[assignment.index] =
            value(assignment.value, state, position);
    }
    return {value(code.rho, state, position), value(code.lower, state, position).low,
            value(code.upper, state, position).high};
}

etlmon::Reading Evaluator::run(const Table& table, State::OfReading& state) const {
    for (std::size_t g = 0; g < table.guards.size(); ++g) {
        state.guards[g] = kTrue;
        for (Slot slot : table.guards[g])
            state.guards[g] = etlmon::min_of(state.guards[g], streams_[slot]);
    }
    std::transform(table.weak.begin(), table.weak.end(), state.weak.begin() + 1,
                   [&](Slot slot) { return streams_[slot].low; });
    std::transform(table.strong.begin(), table.strong.end(), state.strong.begin() + 1,
                   [&](Slot slot) { return streams_[slot].high; });
    const auto states = static_cast<std::uint32_t>(table.ends.size());
    etlmon::machine_advance(state.registers.data(), state.next.data(), states,
                            table.transitions.data(), table.ends.data(), state.guards.data());
    std::swap(state.registers, state.next);
    return etlmon::machine_read(state.registers.data(), states, table.owed.data(),
                                state.weak.data(), state.strong.data());
}

// ---- the last positions, again at every step
// -----------------------------------------------------

PendingEvaluator::PendingEvaluator(const Pending& pending) : pending_(&pending) {
    leaves_.resize(pending.parts.size());
    const std::size_t positions = pending.horizon + std::size_t{1};
    for (auto& leaf : leaves_) leaf.reserve(positions);
    parts_.assign(pending.parts.size(), Readings(positions));
    if (!pending.is_fold) {
        const Table& table = pending.table;
        guards_.resize(positions * table.guards.size());
        weak_.assign(table.weak.size() + 1, etlmon::kTop);
        strong_.assign(table.strong.size() + 1, etlmon::kTop);
        scratch_.resize(2 * table.ends.size());
        values_.resize(table.guards.size() + table.ends.size());
    }
    reset();
}

void PendingEvaluator::reset() {
    for (auto& leaf : leaves_) leaf.clear();
    if (pending_->is_fold) {
        registers_.resize(2);
        registers_[0] = neutral(pending_->fold.max);
        registers_[1] = neutral(!pending_->fold.max);
    } else {
        registers_.assign(pending_->table.ends.size(), kFalse);
        registers_[0] = kTrue;
    }
}

bool PendingEvaluator::fits() const {
    return std::all_of(leaves_.begin(), leaves_.end(), [&](const std::vector<Value>& leaf) {
        return leaf.size() <= pending_->horizon + std::size_t{1};
    });
}

etlmon::Reading PendingEvaluator::advance(std::uint64_t position,
                                          const std::vector<Value>& streams) {
    // The counter saturates as in generated code.
    const auto step = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(position, std::numeric_limits<std::uint32_t>::max()));
    const std::uint32_t count = std::min(step, pending_->horizon) + 1;
    evaluate_parts(count, streams);
    return pending_->is_fold ? advance_fold(step, count, streams)
                             : advance_machine(step, count, streams);
}

void PendingEvaluator::evaluate_parts(std::uint32_t count, const std::vector<Value>& streams) {
    for (std::size_t i = 0; i < pending_->parts.size(); ++i) evaluate_part(i, count, streams);
}

void PendingEvaluator::evaluate_part(std::size_t index, std::uint32_t count,
                                     const std::vector<Value>& streams) {
    const Pending::Part& part = pending_->parts[index];
    Readings& out = parts_[index];
    if (part.leaf != kNone) {
        auto& leaf = leaves_[index];
        if (leaf.size() > pending_->horizon) leaf.erase(leaf.begin());
        leaf.push_back(streams[part.leaf]);
        std::transform(leaf.begin(), leaf.end(), out.begin(),
                       [](Value value) { return etlmon::settled(value); });
        return;
    }
    if (part.unseen == kNone) {
        out = parts_[part.operands[0]];
        for (std::size_t i = 1; i < part.operands.size(); ++i) {
            const Readings& other = parts_[part.operands[i]];
            if (!part.max)
                etlmon::pending_and(out.data(), other.data(), out.data(), count);
            else
                etlmon::pending_or(out.data(), other.data(), out.data(), count);
        }
        return;
    }
    const etlmon::Reading* left =
        part.operands.size() == 2 ? parts_[part.operands[0]].data() : nullptr;
    const etlmon::Reading* right = parts_[part.operands.back()].data();
    const auto [low, high] = part.interval;
    if (part.max)
        etlmon::pending_at_each<etlmon::Seeking>(left, right, out.data(), count, low, high,
                                                 streams[part.unseen].high);
    else
        etlmon::pending_at_each<etlmon::Guarding>(left, right, out.data(), count, low, high,
                                                  streams[part.unseen].low);
}

etlmon::Reading PendingEvaluator::advance_fold(std::uint32_t step, std::uint32_t count,
                                               const std::vector<Value>& streams) {
    const Pending::Part& fold = pending_->fold;
    const etlmon::Reading* left =
        fold.operands.size() == 2 ? parts_[fold.operands[0]].data() : nullptr;
    const etlmon::Reading* right = parts_[fold.operands.back()].data();
    const auto [low, high] = fold.interval;
    if (fold.max)
        return etlmon::pending_from_start<etlmon::Seeking>(registers_[0], registers_[1], left,
                                                           right, count, step, pending_->horizon,
                                                           low, high, streams[fold.unseen].high);
    return etlmon::pending_from_start<etlmon::Guarding>(registers_[0], registers_[1], left, right,
                                                        count, step, pending_->horizon, low, high,
                                                        streams[fold.unseen].low);
}

etlmon::Reading PendingEvaluator::advance_machine(std::uint32_t step, std::uint32_t count,
                                                  const std::vector<Value>& streams) {
    const Table& table = pending_->table;
    const std::size_t width = table.guards.size();
    std::fill(guards_.begin(), guards_.end(), etlmon::settled(kTrue));
    for (std::uint32_t p = 0; p < count; ++p)
        for (std::size_t g = 0; g < width; ++g)
            for (std::uint32_t part : table.guards[g])
                guards_[p * width + g] = min_of(guards_[p * width + g], parts_[part][p]);
    std::transform(table.weak.begin(), table.weak.end(), weak_.begin() + 1,
                   [&](Slot slot) { return streams[slot].low; });
    std::transform(table.strong.begin(), table.strong.end(), strong_.begin() + 1,
                   [&](Slot slot) { return streams[slot].high; });
    const std::size_t states = registers_.size();
    return etlmon::pending_machine(registers_.data(), static_cast<std::uint32_t>(states),
                                   guards_.data(), static_cast<std::uint32_t>(width), count,
                                   step >= pending_->horizon, table.transitions.data(),
                                   table.ends.data(), table.owed.data(), weak_.data(),
                                   strong_.data(), scratch_.data(), values_.data());
}

}  // namespace etlc::execute
