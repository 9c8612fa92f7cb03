// Writes and reads states.
#include <algorithm>

#include "plan/evaluate/archive.hpp"
#include "plan/evaluate/state.hpp"

namespace etlc::plan {

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

}  // namespace etlc::plan
