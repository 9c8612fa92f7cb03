#include "plan/evaluate/state.hpp"

#include <algorithm>

#include "etlmon/scalars.hpp"
#include "etlmon/temporal/window.hpp"

namespace etlc::plan {

using etlmon::kFalse;
using etlmon::kTop;
using etlmon::kTrue;

namespace {

void reset_member(const Member& member, State::OfStream& state) {
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
            state.lows.resize(member.length);
            state.highs.resize(member.length);
            state.sort_counted();
            break;
        case Member::Kind::widening:
            state.values.assign(member.length - member.from_length, neutral(member.max));
            break;
        default: break;  // these belong to readings
    }
}

}  // namespace

void State::OfStream::sort_counted() {
    if (lows.size() != values.size()) return;
    for (std::size_t i = 0; i < values.size(); ++i) {
        lows[i] = values[i].low;
        highs[i] = values[i].high;
    }
    std::sort(lows.begin(), lows.end());
    std::sort(highs.begin(), highs.end());
}

State::State(const Plan& plan, const Shape& shape) {
    const check::Model& model = *plan.model;
    const std::size_t inputs = model.inputs.size(), predicates = model.predicates.size();
    held.resize(inputs);
    freshness.resize(inputs);
    for (const Index i : plan.inputs) {
        if (model.inputs[i].hold > 0) held[i].values.reserve(model.inputs[i].dimension);
        if (model.inputs[i].stale_after > 0) freshness[i].reserve(model.inputs[i].dimension);
    }
    for (const KeptPoint& one : shape.kept)
        earlier.emplace_back(one.point, one.steps, model.points[one.point].dimension);
    for (const Index past : plan.pasts) pasts.emplace_back(model.pasts[past]);
    measured.resize(predicates);
    contrast_rows.resize(predicates);
    for (const check::Predicate& predicate : model.predicates)
        thresholds.push_back(predicate.threshold.value);
    predicate_values.resize(predicates, Value{etlmon::kBottom, kTop});
    flags.resize(inputs, Value{etlmon::kBottom, kTop});
    streams.resize(plan.streams.size());
    readings.resize(plan.readings.size());
    for (std::size_t i = 0; i < plan.readings.size(); ++i)
        if (plan.readings[i].kind == Reading::Kind::pending)
            readings[i].pending.emplace(plan.readings[i].pending);
    verdicts.resize(plan.monitors.size());
    starts.resize(plan.monitors.size());
    restarts.resize(plan.monitors.size());
    reset(plan, shape);
}

void State::reset(const Plan& plan, const Shape& shape) {
    for (Held& one : held) {
        one.values.clear();
        one.age = 0;
    }
    for (Freshness& one : freshness) one.reset();
    for (EarlierSamples& one : earlier) one.reset();
    counts.assign(plan.model->inputs.size(), {});
    for (Slot slot = 0; slot < streams.size(); ++slot) reset_stream(slot, shape);
    for (std::size_t i = 0; i < readings.size(); ++i) reset_reading(i, plan, shape);
    for (PastState& past : pasts) past.reset();
    std::fill(measured.begin(), measured.end(), etlmon::Measured{etlmon::kMissing, 0});
    std::fill(verdicts.begin(), verdicts.end(), etlmon::Verdict{});
    lets.assign(plan.lets.size(), etlmon::Verdict{});
    std::fill(starts.begin(), starts.end(), 0);
    std::fill(restarts.begin(), restarts.end(), false);
    steps = 0;
    started = false;
    finished = 0;
    missing_steps = 0;
}

void State::reset_stream(Slot stream, const Shape& shape) {
    for (const Member& member : shape.streams[stream]) reset_member(member, streams[stream]);
}

void State::reset_reading(std::size_t index, const Plan& plan, const Shape& shape) {
    const Reading& reading = plan.readings[index];
    OfReading& state = readings[index];
    if (reading.kind == Reading::Kind::pending) {
        state.pending->reset();
    } else if (reading.kind == Reading::Kind::table) {
        const Table& table = reading.table;
        state.registers.assign(table.ends.size(), kFalse);
        state.next = state.registers;
        state.registers[0] = kTrue;
        state.guards.assign(table.guards.size(), kTrue);
        state.weak.assign(table.weak.size() + 1, kTop);
        state.strong.assign(table.strong.size() + 1, kTop);
    } else {
        state.registers = shape.registers[index];
        state.next.assign(reading.straight.locals.size(), kFalse);
    }
}

}  // namespace etlc::plan
