#include "execute/state.hpp"

#include <algorithm>

#include "etlmon/scalars.hpp"
#include "etlmon/temporal/window.hpp"
#include "execute/archive.hpp"

namespace etlc::execute {

using namespace plan;

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
    for (const Index d : plan.drifts) drifts.emplace_back(model.drifts[d].cells);
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
    for (etlmon::Drift& drift : drifts) drift.begin();
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

namespace {

using Least = etlmon::Least<etlmon::Key>;
using Greatest = etlmon::Greatest<etlmon::Key>;

}  // namespace

PastState::PastState(const check::Past& past) : kind_(past.kind), steps_(past.steps) {
    if (kind_ == Kind::min || kind_ == Kind::max)
        keys_.resize(etlmon::window_elements(steps_));
    else
        bits_.resize(steps_);
    reset();
}

void PastState::reset() {
    cursor_ = 0;
    count_ = 0;
    mean_.reset();
    std::fill(bits_.begin(), bits_.end(), etlmon::detail::kMissingBits);
    if (kind_ == Kind::min) etlmon::window_reset<Least>(keys_.data(), cursor_, steps_);
    if (kind_ == Kind::max) etlmon::window_reset<Greatest>(keys_.data(), cursor_, steps_);
}

float PastState::push(float x) {
    const std::uint32_t bits = etlmon::bits_of(x);
    switch (kind_) {
        case Kind::ago:
            return etlmon::float_of_bits(etlmon::delay_push(bits_.data(), cursor_, steps_, bits));
        case Kind::mean:
            return etlmon::float_of_bits(etlmon::mean_push(bits_.data(), mean_, steps_, bits));
        case Kind::min:
            return etlmon::float_of_bits(
                etlmon::extreme_push<Least>(keys_.data(), cursor_, count_, steps_, bits));
        case Kind::max:
            return etlmon::float_of_bits(
                etlmon::extreme_push<Greatest>(keys_.data(), cursor_, count_, steps_, bits));
        case Kind::count:
        case Kind::fraction: break;
    }
    return etlmon::kMissing;
}

bool PastState::fits() const {
    const std::uint32_t places = keys_.empty() ? steps_ : std::max(steps_ & ~1U, 1U);
    return cursor_ < std::max(places, 1U) && count_ <= steps_ &&
           mean_.cursor < std::max(steps_, 1U) && mean_.count <= steps_;
}

namespace {

/// Returns how many places the cursor of a member goes through.
std::uint32_t places_of(const Member& member) {
    switch (member.kind) {
        case Member::Kind::delay:
        case Member::Kind::count_window: return member.length;
        case Member::Kind::widening: return member.length - member.from_length;
        case Member::Kind::window:
        case Member::Kind::since_window:
        case Member::Kind::until_window:
        case Member::Kind::handover_window: return std::max(member.length & ~1U, 1U);
        default: return 1;
    }
}

template <class Part, class Archive>
void visit_all(Part& parts, Archive& archive) {
    for (auto& part : parts) part.visit(part, archive);
}

}  // namespace

template <class Self, class Archive>
void State::visit(Self& self, Archive& archive) {
    for (auto& one : self.held) {
        archive.some(one.values);
        archive.number(one.age);
    }
    visit_all(self.freshness, archive);
    visit_all(self.earlier, archive);
    archive.fixed(self.counts);
    visit_all(self.pasts, archive);
    archive.fixed(self.measured);
    for (auto& [left, right] : self.contrast_rows) {
        archive.number(left);
        archive.number(right);
    }
    archive.fixed(self.thresholds);
    archive.fixed(self.drifts);
    archive.fixed(self.predicate_values);
    archive.fixed(self.flags);
    for (auto& stream : self.streams) {
        archive.fixed(stream.values);
        archive.fixed(stream.pairs);
        archive.fixed(stream.flanks);
        archive.number(stream.cursor);
    }
    for (auto& reading : self.readings) {
        archive.fixed(reading.registers);
        archive.fixed(reading.next);
        archive.fixed(reading.guards);
        archive.fixed(reading.weak);
        archive.fixed(reading.strong);
        if (reading.pending) PendingEvaluator::visit(*reading.pending, archive);
    }
    archive.fixed(self.verdicts);
    archive.fixed(self.lets);
    archive.number(self.steps);
    archive.fixed(self.starts);
    archive.bools(self.restarts);
    archive.flag(self.started);
    archive.number(self.finished);
    archive.number(self.missing_steps);
}

void State::write(std::vector<std::uint8_t>& bytes) const {
    Writer archive(bytes);
    visit(*this, archive);
}

bool State::read(std::span<const std::uint8_t>& bytes, const Plan& plan, const Shape& shape) {
    Reader archive(bytes);
    visit(*this, archive);
    bytes = archive.rest();
    for (OfStream& stream : streams) stream.sort_counted();
    return archive.good() && fits(plan, shape);
}

/// Checks what the runtime uses as a place in memory.
bool State::fits(const Plan& plan, const Shape& shape) const {
    const std::vector<check::Input>& inputs = plan.model->inputs;
    for (Index i = 0; i < inputs.size(); ++i) {
        const std::size_t values = held[i].values.size();
        if (values != 0 && values != inputs[i].dimension) return false;
        if (!freshness[i].fits(inputs[i])) return false;
    }
    for (Slot slot = 0; slot < streams.size(); ++slot)
        for (const Member& member : shape.streams[slot])
            if (streams[slot].cursor >= places_of(member)) return false;
    for (const OfReading& reading : readings)
        if (reading.pending && !reading.pending->fits()) return false;
    const auto fit = [](const auto& one) { return one.fits(); };
    return std::all_of(earlier.begin(), earlier.end(), fit) &&
           std::all_of(pasts.begin(), pasts.end(), fit) &&
           std::all_of(starts.begin(), starts.end(),
                       [&](std::uint64_t start) { return start <= steps; });
}

}  // namespace etlc::execute
