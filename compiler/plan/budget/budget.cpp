#include "plan/budget/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "etlmon/distance/layout.hpp"
#include "etlmon/hosted/footprint.hpp"
#include "etlmon/past/numbers.hpp"
#include "etlmon/past/points.hpp"
#include "etlmon/temporal/drift.hpp"
#include "plan/program/program.hpp"
#include "plan/program/sample_codes.hpp"
#include "plan/program/value_type.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::plan {

namespace {

using check::Values;

Cost distance_cost(const check::Model& model, const check::Distance& distance) {
    const std::uint32_t dimension = model.points[distance.point].dimension;
    const bool between = distance.is_between_points();
    const std::uint64_t rows = between ? 1 : model.targets[distance.target].rows;
    const std::uint64_t elements = rows * dimension;
    // Between points, cosine and angular scale the second one to length 1; kth keeps the smallest.
    const bool scales = between && check::is_of_directions(distance.metric);
    const bool keeps = distance.aggregation == check::Aggregation::kth;
    return {.stack_bytes = (scales  ? dimension
                            : keeps ? distance.kth
                                    : 0) *
                           kWord,
            .distance_operations = distance.full_weights() ? elements * (1 + dimension) : elements};
}

/// Returns the cost of a point that a step computes: its array, if it needs one; of a projected
/// point with an offset also one for the centred point.
Cost point_cost(const check::Model& model, const check::Point& point) {
    if (!point.is_projected()) {
        const bool in_place =
            point.is_delayed() && earlier_element_bytes(model, point.inner) == sizeof(float);
        const std::uint64_t terms = point.factors.size();
        return {.stack_bytes = in_place ? 0 : point.dimension * kWord,
                .code_bytes = kCodePerRing * std::max<std::uint64_t>(terms, 1),
                .distance_operations = terms * point.dimension};
    }
    const check::Projection& map = model.projections[point.projection];
    const std::uint64_t centred = map.offset.empty() ? 0 : map.dimension;
    return {.stack_bytes = (map.rows + centred) * kWord,
            .code_bytes = kCodePerRing,
            .distance_operations = std::uint64_t{map.rows} * map.dimension};
}

std::uint64_t bytes_of_element(check::InputType type) {
    if (type == check::InputType::i8) return sizeof(std::int8_t);
    return type == check::InputType::f16 ? sizeof(std::uint16_t) : sizeof(float);
}

/// Returns the cost of an embedding whose elements become float32.
Cost widening_cost(const check::Input& input) {
    const bool widens = input.is_embedding() && input.type != check::InputType::f32;
    return {.stack_bytes = widens ? input.dimension * kWord : 0};
}

Cost hold_cost(const check::Input& input) {
    if (input.hold == 0) return {};
    return {.state_bytes = (std::uint64_t{input.dimension} + 1) * kWord,
            .code_bytes = kCodePerRing,
            .operations = 1};
}

/// Returns the cost of `stale after`: the last sample as the input stores it, and a counter.
Cost stale_cost(const check::Input& input) {
    if (input.stale_after == 0) return {};
    const std::uint64_t sample = bytes_of_element(input.type) * input.dimension;
    return {.state_bytes = (sample + kWord - 1) / kWord * kWord + kWord,
            .code_bytes = kCodePerRing,
            .operations = 1,
            .distance_operations = input.is_embedding() ? input.dimension : 0};
}

/// Collects the parts of a plan that one monitor, or all of them, need.
class Needs {
public:
    explicit Needs(const Plan& plan) : plan_(plan) {}

    void stream(Slot slot) {
        if (!streams_.insert(slot).second) return;
        const Stream& s = plan_.streams[slot];
        if (s.op == StreamOp::predicate) predicate(s.index);
        if (s.op == StreamOp::flag) inputs_.insert(s.index);
        for (Slot operand : s.operands) stream(operand);
    }

    void reading(std::uint32_t index) {
        if (!readings_.insert(index).second) return;
        const Reading& r = plan_.readings[index];
        for (std::uint32_t operand : r.operands) reading(operand);
        for_each_slot(r, [&](Slot slot) { stream(slot); });
    }

    void drift(const check::Drift& drift) {
        if (drift.predicate != kNone) predicate(drift.predicate);
    }

    void monitor(const Monitor& monitor) {
        monitor.sliding ? stream(monitor.stream) : reading(monitor.reading);
    }

    Cost cost() const {
        const check::Model& model = *plan_.model;
        Cost sum;
        for (Slot slot : streams_) sum = sum + cost_of(plan_.streams[slot], plan_.values);
        for (std::uint32_t index : readings_)
            sum = sum + cost_of(plan_.readings[index], plan_.values);
        for (Index p : predicates_) sum = sum + telemetry(model.predicates[p]);
        for (Index p : pasts_) sum = sum + cost_of(model.pasts[p]);
        const std::vector<Index> distances(distances_.begin(), distances_.end());
        for (Index p : built_points(model, distances))
            sum = sum + point_cost(model, model.points[p]);
        for (const EarlierPoint& earlier : earlier_points(model, distances))
            sum = sum + cost_of(model, earlier);
        for (Index d : distances_) {
            sum = sum + distance_cost(model, model.distances[d]);
            if (searches(plan_, d))
                sum.state_bytes += search_bytes(model.targets[model.distances[d].target]);
        }
        sum.target_bytes = target_bytes(plan_, distances_, Vectors::with);
        sum.scalar_target_bytes = target_bytes(plan_, distances_, Vectors::without);
        for (Index i : inputs_)
            sum = sum + widening_cost(model.inputs[i]) + hold_cost(model.inputs[i]) +
                  stale_cost(model.inputs[i]);
        return sum;
    }

private:
    Cost telemetry(const check::Predicate& predicate) const {
        if (predicate.name.empty()) return {.code_bytes = kCodePerRing};
        Cost cost{.state_bytes = predicate.plain_distance() ? 2 * kWord : kWord,
                  .code_bytes = kCodePerRing};
        if (!predicate.plain_distance())
            cost.state_bytes += kWord * check::measured_targets(*plan_.model, predicate).size();
        if (predicate.threshold.adaptation)
            cost = cost + Cost{.state_bytes = kWord, .code_bytes = kCodePerAdaptation};
        return cost;
    }

    void predicate(Index index) {
        if (!predicates_.insert(index).second) return;
        const check::Predicate& p = plan_.model->predicates[index];
        inputs_.insert(p.inputs.begin(), p.inputs.end());
        check::for_each(p.expression, [&](const check::Expr& e) {
            if (e.kind == check::Expr::Kind::distance) distances_.insert(e.index);
            if (e.kind == check::Expr::Kind::past) pasts_.insert(e.index);
        });
    }

    const Plan& plan_;
    std::set<Slot> streams_;
    std::set<std::uint32_t> readings_;
    std::set<Index> pasts_;
    std::set<Index> predicates_;
    std::set<Index> distances_;
    std::set<Index> inputs_;
};

}  // namespace

std::uint64_t measured_elements(const check::Model& model, Index predicate) {
    std::uint64_t sum = 0;
    check::for_each_distance(model.predicates[predicate].expression, [&](Index d) {
        sum += distance_cost(model, model.distances[d]).distance_operations;
    });
    return sum;
}

std::uint64_t elements_of(const check::Model& model, Index predicate) {
    std::uint64_t sum = measured_elements(model, predicate);
    for (const Index p : projected_points(model, model.predicates[predicate].distances()))
        sum += point_cost(model, model.points[p]).distance_operations;
    return sum;
}

Cost operator+(Cost a, const Cost& b) {
    a.state_bytes += b.state_bytes;
    a.stack_bytes += b.stack_bytes;
    a.target_bytes += b.target_bytes;
    a.scalar_target_bytes += b.scalar_target_bytes;
    a.code_bytes += b.code_bytes;
    a.operations += b.operations;
    a.distance_operations += b.distance_operations;
    return a;
}

bool within(const Cost& cost, const Limits& limits) {
    return cost.state_bytes + cost.stack_bytes <= limits.state_bytes &&
           cost.code_bytes <= limits.code_bytes && cost.operations <= limits.operations;
}

std::string what_takes_stack(const Plan& plan) {
    const check::Model& model = *plan.model;
    std::string list;
    const auto add = [&](std::string_view what, const Cost& cost) {
        if (cost.stack_bytes == 0 || list.find(what) != std::string::npos) return;
        list.append(list.empty() ? "" : ", ").append(what);
    };
    for (const Reading& reading : plan.readings)
        add("positions evaluated again", cost_of(reading, plan.values));
    for (const Stream& stream : plan.streams) add("counts", cost_of(stream, plan.values));
    for (const Index i : plan.inputs) add("widened embeddings", widening_cost(model.inputs[i]));
    for (const Index p : built_points(model, plan.distances))
        add(model.points[p].is_projected() ? "projected points" : "points of distances",
            point_cost(model, model.points[p]));
    for (const Index d : plan.distances)
        add(model.distances[d].is_between_points() ? "points scaled to length 1" : "kth",
            distance_cost(model, model.distances[d]));
    return list;
}

std::string in_words(const Cost& cost) {
    const std::string stack = cost.stack_bytes == 0
                                  ? ""
                                  : fmt::format(" and {} on the stack of a step", cost.stack_bytes);
    return fmt::format("{} bytes of state{}, {} bytes of code (estimated), {} operations a step",
                       cost.state_bytes, stack, cost.code_bytes, cost.operations);
}

Cost cost_of(const check::Model& model, const EarlierPoint& earlier) {
    return {
        .state_bytes = etlmon::earlier_bytes(earlier_element_bytes(model, earlier.point),
                                             model.points[earlier.point].dimension, earlier.steps),
        .code_bytes = kCodePerRing,
        .operations = 1};
}

Cost cost_of(const check::Past& past) {
    using Kind = check::Past::Kind;
    const std::uint64_t numbers = past.steps * kWord;
    switch (past.kind) {
        case Kind::ago: return {.state_bytes = kWord + numbers, .code_bytes = kCodePerRing};
        case Kind::mean:
            return {.state_bytes = sizeof(etlmon::MeanState) + numbers, .code_bytes = kCodePerMean};
        case Kind::min:
        case Kind::max: break;
        case Kind::count:
        case Kind::fraction: return {};
    }
    return {.state_bytes = (2 + etlmon::window_elements(past.steps)) * kWord,
            .code_bytes = kCodePerWindow + kCodePerRing,
            .operations = etlmon::window_operations(past.steps)};
}

void add_costs(Plan& plan) {
    const ValueType& type = value_type(plan.values);
    Needs all(plan);
    Cost fixed{.state_bytes = kWord};  // missing steps
    if (plan.counts_steps) fixed.state_bytes += kWord;
    if (plan.has_sliding) fixed.state_bytes += kWord;  // calls of finish()
    for (const Monitor& monitor : plan.monitors) {
        Needs own(plan);
        own.monitor(monitor);
        all.monitor(monitor);
        plan.monitor_costs.push_back(own.cost());
        // The last verdict is kept where a final one stays, and where finish() repeats those of
        // prefix monitors.
        const bool kept = type.on_demand || (plan.has_sliding && !monitor.sliding);
        if (kept) fixed.state_bytes += type.verdict;
        if (monitor.counts_steps) fixed.state_bytes += kWord;
        const bool counts_verdicts = monitor.restarts == check::Restarts::when_final;
        if (counts_verdicts) fixed.state_bytes += 2 * kWord;  // alarms and fulfilments
    }
    if (type.sourced) {
        fixed.state_bytes += bytes_of(samples(plan), plan.monitors.size());
        fixed.code_bytes += kCodePerSamples;
    }
    for (const Let& let : plan.lets) {
        all.stream(let.stream);
        fixed.state_bytes += type.verdict;
    }
    for (const Index d : plan.drifts) {
        all.drift(plan.model->drifts[d]);
        fixed = fixed + Cost{.state_bytes = sizeof(etlmon::Drift), .code_bytes = kCodePerDrift};
    }
    plan.cost = all.cost() + fixed;
    plan.cost.state_bytes = (plan.cost.state_bytes + kWord - 1) / kWord * kWord;
}

namespace {

constexpr std::uint64_t kMuch = std::uint64_t{1} << 40U;  // shared parts count once per operand
constexpr std::uint64_t kManyAsks = 16;

bool passes_on(StreamOp op) {
    return op == StreamOp::negation || op == StreamOp::combination || op == StreamOp::within;
}

Demand of_operands(const Stream& stream, const std::vector<Demand>& known, bool is_shared) {
    Demand demand{.asks = 0};
    for (Slot operand : stream.operands) {
        demand.asks += known[operand].keeps ? 1 : known[operand].asks;
        demand.lazy = demand.lazy || known[operand].lazy;
        demand.work = std::min(kMuch, demand.work + known[operand].work);
    }
    if (stream.op == StreamOp::within) demand.asks = 1;  // its value is kept anyway
    demand.keeps = demand.lazy && is_shared && demand.asks > kManyAsks;
    return demand;
}

}  // namespace

bool found_on_demand(const Stream& stream, const std::vector<bool>& known) {
    if (stream.op == StreamOp::predicate || stream.op == StreamOp::flag) return true;
    return passes_on(stream.op) && std::any_of(stream.operands.begin(), stream.operands.end(),
                                               [&](Slot operand) { return known[operand]; });
}

std::vector<Demand> demands(const Plan& plan) {
    std::vector<int> users(plan.streams.size());
    for (const Stream& stream : plan.streams)
        for (Slot operand : stream.operands) ++users[operand];
    std::vector<Demand> result(plan.streams.size());
    if (!value_type(plan.values).on_demand) return result;
    for (Slot slot = 0; slot < plan.streams.size(); ++slot) {  // operands come first
        const Stream& stream = plan.streams[slot];
        if (stream.op == StreamOp::predicate)
            result[slot] = {.lazy = true, .work = measured_elements(*plan.model, stream.index)};
        else if (stream.op == StreamOp::flag)
            result[slot].lazy = true;
        else if (passes_on(stream.op))
            result[slot] = of_operands(stream, result, users[slot] > 1);
    }
    return result;
}

namespace {

std::uint64_t element_bytes(Storage storage) {
    switch (storage) {
        case Storage::f32: return sizeof(float);
        case Storage::f16: return sizeof(std::uint16_t);
        case Storage::i8: break;
    }
    return sizeof(std::int8_t);
}

/// Rounds up to cache lines, because columns are an aligned struct.
std::uint64_t whole_lines(std::uint64_t bytes) {
    constexpr std::uint64_t kLine = 64;
    return (bytes + kLine - 1) / kLine * kLine;
}

/// Sums the arrays of an object, each once.
class Arrays {
public:
    Arrays(const Plan& plan, bool vectors) : plan_(plan), vectors_(vectors) {}

    void add(Index d) {
        const check::Distance& distance = plan_.model->distances[d];
        bytes_ += distance.weights.size() * sizeof(float);
        if (distance.is_between_points()) return;
        const NarrowSet* narrow = narrow_set(plan_, d);
        if (narrow != nullptr) add_rows(distance, narrow->storage);
        if (const StoredSet* stored = stored_set(plan_, d)) {
            if (stored_.insert(stored).second)
                bytes_ += plan_.model->targets[stored->target].rows * stored->row_bytes;
        } else if (narrow == nullptr || !narrow->lossless) {
            add_rows(distance, Storage::f32);
        }
    }

    void add_projection(Index index) {
        if (!projections_.insert(index).second) return;
        const check::Projection& map = plan_.model->projections[index];
        const StoredSet* const stored = stored_projection(plan_, index);
        bytes_ += stored != nullptr ? stored->row_bytes : map.matrix.size() * sizeof(float);
        bytes_ += map.offset.size() * sizeof(float);
    }

    std::uint64_t bytes() const { return bytes_; }

private:
    using Rows = std::pair<Index, bool>;  ///< a target, as given or normalised
    static Rows rows_of(const check::Distance& distance) {
        return {distance.target, rows_as_given(distance)};
    }

    void add_rows(const check::Distance& distance, Storage storage) {
        const check::Target& target = plan_.model->targets[distance.target];
        const std::uint32_t rows = target.rows;
        const std::uint32_t dimension = target.dimension;
        // Retargetable classes store plain rows for all machines.
        const bool columns = !plan_.model->retargetable &&
                             metric_id(distance) != etlmon::MetricId::mahalanobis &&
                             etlmon::detail::in_columns(rows, dimension, vectors_);
        if (!arrays_.emplace(rows_of(distance), storage, columns).second) return;
        if (columns)
            bytes_ += whole_lines(element_bytes(storage) *
                                  etlmon::detail::column_elements(rows, dimension, vectors_));
        else
            bytes_ += element_bytes(storage) * rows * dimension;
    }

    const Plan& plan_;
    bool vectors_;
    std::set<std::tuple<Rows, Storage, bool>> arrays_;
    std::set<const StoredSet*> stored_;
    std::set<Index> projections_;
    std::uint64_t bytes_ = 0;
};

}  // namespace

std::uint64_t target_bytes(const Plan& plan, const std::set<Index>& distances, Vectors vectors) {
    Arrays arrays(plan, vectors == Vectors::with);
    for (Index d : distances) arrays.add(d);
    for (Index p : projected_points(*plan.model, {distances.begin(), distances.end()}))
        arrays.add_projection(plan.model->points[p].projection);
    return arrays.bytes();
}

}  // namespace etlc::plan
