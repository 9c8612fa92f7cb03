#include "plan/samples.hpp"

#include <algorithm>

#include "etlmon/temporal/samples.hpp"

namespace etlc::plan {

namespace {

/// How old a sample of each stream's value may be, unless it is one of a followed value.
std::vector<std::uint64_t> ages(const std::vector<Stream>& streams) {
    std::vector<std::uint64_t> result;
    for (const Stream& stream : streams) {  // operands come first
        std::uint64_t age = 0;
        for (const Slot operand : stream.operands) age = std::max(age, result[operand]);
        switch (stream.op) {
            case StreamOp::delay:
            case StreamOp::shift: age += stream.length; break;
            case StreamOp::window:
            case StreamOp::window_since:
            case StreamOp::window_until:
            case StreamOp::window_handover: age += stream.length - 1; break;
            case StreamOp::widening: age += stream.length - stream.from_length; break;
            default: break;
        }
        result.push_back(age);
    }
    return result;
}

/// How far the bounded operators of each formula reach ahead, one in the other.
std::vector<std::uint64_t> reaches(const ir::Graph& graph) {
    std::vector<std::uint64_t> result;
    for (NodeId id = 0; id < graph.size(); ++id) {
        const ir::Node& node = graph[id];
        std::uint64_t reach = 0;
        for (const NodeId operand : node.operands) reach = std::max(reach, result[operand]);
        const bool ahead = ir::info(node.op).tense == ir::Tense::future && node.interval.bounded();
        result.push_back(reach + (ahead ? node.interval.high : 0));
    }
    return result;
}

std::uint32_t steps_of(const Plan& plan) {
    const std::vector<std::uint64_t> of_streams = ages(plan.streams);
    const std::vector<std::uint64_t> ahead = reaches(*plan.formulas);
    std::uint64_t most = 0;
    for (const std::uint64_t age : of_streams) most = std::max(most, age);
    for (const Reading& reading : plan.readings) {
        // A formula over the last positions has these; a machine what it has not settled.
        const std::uint64_t held = reading.kind == Reading::Kind::pending ? reading.pending.horizon
                                   : table_of(reading) != nullptr         ? ahead[reading.node]
                                                                          : 0;
        for_each_slot(reading, [&](Slot slot) { most = std::max(most, of_streams[slot] + held); });
    }
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(most + 1, check::kUnbounded));
}

std::uint32_t followed_in(const std::vector<Member>& members) {
    return static_cast<std::uint32_t>(std::count_if(members.begin(), members.end(), is_followed));
}

std::size_t declared_at(const check::Model& model, Samples::Place place) {
    return place.is_predicate ? model.predicates[place.index].span.begin
                              : model.inputs[place.index].span.begin;
}

}  // namespace

bool is_followed(const Member& member) {
    return member.kind == Member::Kind::value || member.kind == Member::Kind::variable;
}

std::uint32_t Samples::place_of(bool is_predicate, Index index) const {
    const auto place = std::find_if(places.begin(), places.end(), [&](const Place& of) {
        return of.is_predicate == is_predicate && of.index == index;
    });
    return static_cast<std::uint32_t>(place - places.begin());
}

Samples samples(const Plan& plan) {
    const check::Model& model = *plan.model;
    Samples result;
    for (const Index p : plan.predicates) {
        result.places.push_back({true, p});
        result.has_rows = result.has_rows || model.predicates[p].plain_distance();
        result.adapts = result.adapts || model.predicates[p].threshold.adaptation;
    }
    for (const Index i : plan.inputs)
        if (model.inputs[i].type == check::InputType::boolean) result.places.push_back({false, i});
    std::stable_sort(result.places.begin(), result.places.end(),
                     [&](auto a, auto b) { return declared_at(model, a) < declared_at(model, b); });
    result.steps = steps_of(plan);
    for (const Reading& reading : plan.readings)
        result.followed +=
            followed_in(members_of(reading)) + (table_of(reading) != nullptr ? 1 : 0);
    for (const Stream& stream : plan.streams) result.followed += followed_in(members_of(stream));
    result.followed = std::max(1U, result.followed);
    return result;
}

std::uint64_t bytes_of(const Samples& samples, std::size_t monitors) {
    if (samples.places.empty()) return 0;
    constexpr std::uint64_t kCounters = 8, kAnswer = 20;
    const std::uint64_t seen = samples.adapts     ? sizeof(etlmon::SeenAdapting)
                               : samples.has_rows ? sizeof(etlmon::Seen)
                                                  : sizeof(etlmon::SeenNumber);
    return kCounters + samples.followed * 2 * (sizeof(etlmon::Rank) + seen) + monitors * kAnswer +
           std::uint64_t{samples.steps} * samples.places.size() * seen;
}

}  // namespace etlc::plan
