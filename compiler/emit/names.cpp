#include "emit/names.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "emit/text/identifiers.hpp"
#include "emit/text/layout.hpp"
#include "plan/program/dependents.hpp"
#include "plan/program/value_type.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::emit {

namespace {

/// Claims the name of a data member.
std::string member(Scope& scope, const std::string& name) {
    return scope.claim(name, "_");
}

/// Claims the name of a local. It contains an underscore, unlike other names of the class.
std::string local(Scope& scope, const std::string& name) {
    return name.find('_') == std::string::npos ? scope.number(name) : scope.claim(name);
}

/// Returns whether the stream is a constant, a predicate or a bool input.
bool is_atom(plan::StreamOp op) {
    return op == plan::StreamOp::constant || op == plan::StreamOp::predicate ||
           op == plan::StreamOp::flag;
}

std::string predicate_name(const check::Predicate& predicate) {
    if (!predicate.name.empty()) return predicate.name;
    return identifier(predicate.text + predicate.threshold.text, "comparison");
}

class Naming {
public:
    explicit Naming(const plan::Plan& plan)
        : plan_(plan),
          model_(*plan.model),
          graph_(*plan.formulas),
          on_demand_(plan::value_type(plan.values).on_demand),
          judge_(function_names(plan)),
          measure_scope_(function_names(plan)),
          measure_(on_demand_ ? judge_ : measure_scope_) {}

    Names name_all() {
        name_atoms();
        name_measurements();
        name_nearest();
        name_streams();
        name_readings();
        name_constants();
        return std::move(names_);
    }

private:
    /// Claims the name of an atom: a field of Atoms, or a local of a Boolean class.
    std::string atom(const std::string& name) {
        return on_demand_ ? local(judge_, name + "_now") : atoms_.claim(name);
    }

    void name_atoms() {
        for (const plan::Stream& stream : plan_.streams)
            if (stream.op == plan::StreamOp::flag)
                names_.flag_atom[stream.index] = atom(model_.inputs[stream.index].name);
        for (check::Index p : plan_.predicates)
            if (!model_.predicates[p].name.empty())
                names_.predicate_atom[p] = atom(model_.predicates[p].name);
        for (check::Index p : plan_.predicates)
            if (model_.predicates[p].name.empty())
                names_.predicate_atom[p] =
                    local(on_demand_ ? judge_ : atoms_, predicate_name(model_.predicates[p]));
        for (check::Index p : plan_.predicates) {
            const check::Predicate& predicate = model_.predicates[p];
            if (!on_demand_) names_.predicate_unseen[p] = "unseen_" + names_.predicate_atom[p];
            if (!predicate.name.empty()) continue;
            if (!on_demand_)
                for (Scope* scope : {&judge_, &measure_}) scope->claim(names_.predicate_unseen[p]);
            names_.predicate_local[p] = local(measure_, predicate_name(predicate) + "_delta");
        }
    }

    void name_measurements() {
        std::map<check::Index, int> uses = plan::scalar_uses(plan_);
        for (check::Index i : plan_.inputs) {
            const check::Input& input = model_.inputs[i];
            if (uses[i] == 1 && !input.has_state()) continue;  // a scalar, read in place
            if (input.type == check::InputType::f32 && plan::left_to_kernels(plan_, i)) {
                if (plan::shares_direction(plan_, i))
                    names_.direction_local[i] = local(measure_, input.name + "_direction");
                continue;
            }
            names_.input_local[i] = local(measure_, input.name + "_sample");
            names_.input_buffer[i] = local(measure_, input.name + "_values");
            if (input.hold > 0) names_.hold_member[i] = member(members_, input.name + "_held");
            if (input.stale_after > 0)
                names_.stale_member[i] = member(members_, input.name + "_repeats");
        }
        for (check::Index p : plan_.predicates) {
            const check::Predicate& predicate = model_.predicates[p];
            if (!predicate.name.empty())
                names_.predicate_member[p] = member(members_, predicate.name);
            if (!predicate.threshold.adaptation) continue;
            names_.threshold_member[p] = member(members_, predicate.name + "_threshold");
            names_.adaptation_constant[p] = member(members_, predicate.name + "_adaptation");
        }
        for (const check::Index d : plan_.drifts) {
            const std::string& name = model_.drifts[d].name;
            names_.drifts[d] = {member(members_, name), member(members_, name + "_cells")};
        }
        for (check::Index p : plan::built_points(model_, plan_.distances)) {
            const check::Point& point = model_.points[p];
            const std::string name = identifier(point.text, point.is_sum() ? "sum" : "point");
            const std::string ago = point.is_delayed() ? "_ago" : "";
            names_.point_local[p] = local(measure_, name + ago);
            names_.point_buffer[p] = local(measure_, name + "_values");
        }
        for (const plan::EarlierPoint& earlier : plan::earlier_points(model_, plan_.distances))
            names_.earlier_member[earlier.point] = member(
                members_, identifier(model_.points[earlier.point].text, "point") + "_earlier");
        for (check::Index d : plan_.distances)
            names_.distance_local[d] = local(measure_, distance_name(model_.distances[d]));
        for (check::Index p : plan_.pasts) {
            const std::string name = name_of(model_, model_.pasts[p]);
            names_.past_local[p] = local(measure_, name);
            names_.past_member[p] = member(members_, name);
        }
    }

    /// Returns "min_l2_z_goal"; "to_goal" if that is too long, or may change in a retargetable
    /// class.
    std::string distance_name(const check::Distance& distance) const {
        if (distance.is_between_points()) return identifier(distance.text, "between_points");
        const std::string to_target = "to_" + model_.targets[distance.target].name;
        return model_.retargetable ? to_target : identifier(distance.text, to_target);
    }

    /// Names the nearest rows "nearest_P_T", where T is the target set.
    void name_nearest() {
        Scope functions;
        for (check::Index p : plan_.predicates)
            functions.claim("nearest_" + model_.predicates[p].name);
        for (check::Index p : plan_.predicates) {
            const check::Predicate& predicate = model_.predicates[p];
            if (predicate.name.empty() || predicate.plain_distance()) continue;
            for (check::Index d : check::measured_targets(model_, predicate)) {
                const std::string name = fmt::format(
                    "{}_{}", predicate.name, model_.targets[model_.distances[d].target].name);
                names_.nearest[{p, d}] = {member(members_, name + "_nearest"),
                                          functions.claim("nearest_" + name)};
            }
        }
    }

    void name_streams() {
        for (const plan::Stream& stream : plan_.streams) {
            Names::OfStream& names = names_.streams.emplace_back();
            if (is_atom(stream.op)) continue;
            const std::string name = stream_name(stream);
            names.local = local(judge_, name);
            if (!plan::members_of(stream).empty()) names.member = member(members_, name);
        }
    }

    std::string stream_name(const plan::Stream& stream) const {
        if (stream.node != plan::kNone) {
            const std::string words = name_of(graph_, stream.node);
            if (!words.empty()) return words;
        }
        if (!stream.called.empty()) return std::string(stream.called);
        if (stream.op == plan::StreamOp::predicate)
            return predicate_name(model_.predicates[stream.index]);
        if (stream.op == plan::StreamOp::flag) return model_.inputs[stream.index].name;
        if (stream.operands.empty()) return "value";
        const bool of_constant = plan_.streams[stream.operands[0]].op == plan::StreamOp::constant;
        if (stream.op == plan::StreamOp::within && of_constant)
            return fmt::format("from_step_{}", stream.interval.low);
        const std::string signal = stream_name(signal_of(stream));
        if (signal.size() > kLongestName) return "value";
        return stream.op == plan::StreamOp::combination ? with_more(signal, stream.max)
                                                        : signal + suffix_of(stream);
    }

    /// Returns the last operand; of a window that widens a shorter one, the operand of both.
    const plan::Stream& signal_of(const plan::Stream& stream) const {
        const plan::Stream& operand = plan_.streams[stream.operands.back()];
        return stream.from_length > 0 ? signal_of(operand) : operand;
    }

    /// Returns what the name of a stream without a formula adds to that of its signal.
    static std::string suffix_of(const plan::Stream& stream) {
        switch (stream.op) {
            case plan::StreamOp::within: return "_within";
            case plan::StreamOp::delay: return "_delayed";
            case plan::StreamOp::shift: return "_before";
            case plan::StreamOp::running: return "_so_far";
            case plan::StreamOp::since: return "_pending";
            case plan::StreamOp::negation: return "_negated";
            case plan::StreamOp::window:
            case plan::StreamOp::widening:
            case plan::StreamOp::window_since:
            case plan::StreamOp::window_until:
            case plan::StreamOp::window_count:
            case plan::StreamOp::window_handover: return fmt::format("_last_{}", stream.length);
            default: return "_value";
        }
    }

    void name_readings() {
        std::map<std::uint32_t, std::string> wanted;
        for (std::size_t m = 0; m < plan_.monitors.size(); ++m) {
            const plan::Monitor& monitor = plan_.monitors[m];
            if (monitor.sliding) continue;
            wanted.emplace(monitor.reading, monitor.name);
            const bool repeats = monitor.restarts == check::Restarts::when_final;
            if (on_demand_ && (!repeats || plan_.has_sliding))
                names_.open_local[m] = local(judge_, monitor.name + "_open");
            else if (plan_.has_sliding)
                names_.verdict_member[m] = member(members_, monitor.name + "_verdict");
            if (monitor.counts_steps)
                names_.position_member[m] = member(members_, monitor.name + "_position");
            if (!repeats) continue;
            names_.alarms_member[m] = member(members_, monitor.name + "_alarms");
            names_.fulfilled_member[m] = member(members_, monitor.name + "_fulfilled");
        }
        for (const plan::Let& let : plan_.lets)
            names_.let_member.push_back(member(members_, model_.lets[let.index].name + "_verdict"));
        for (std::uint32_t r = 0; r < plan_.readings.size(); ++r) {
            const auto given = wanted.find(r);
            const std::string name = given == wanted.end() ? part_name(r) : given->second;
            Names::OfReading& names = names_.readings.emplace_back();
            names.local = local(judge_, name + "_reading");
            name_state(plan_.readings[r], name, names);
        }
    }

    /// Returns the name of a part of a monitor's formula: the words of the part if they are few.
    std::string part_name(std::uint32_t r) const {
        return identifier(graph_.short_text(plan_.readings[r].node),
                          monitor_of_[r] == nullptr ? "part" : monitor_of_[r]->name + "_part");
    }

    /// Returns, per reading, the first monitor that contains it. Operands come before the readings
    /// that combine them.
    std::vector<const plan::Monitor*> first_monitors() const {
        std::vector<std::size_t> first(plan_.readings.size(), plan_.monitors.size());
        for (std::size_t m = plan_.monitors.size(); m-- > 0;)
            if (!plan_.monitors[m].sliding) first[plan_.monitors[m].reading] = m;
        for (std::size_t r = first.size(); r-- > 0;)
            for (const std::uint32_t operand : plan_.readings[r].operands)
                first[operand] = std::min(first[operand], first[r]);
        std::vector<const plan::Monitor*> result;
        for (const std::size_t m : first)
            result.push_back(m < plan_.monitors.size() ? &plan_.monitors[m] : nullptr);
        return result;
    }

    /// Names the members of a reading, and its locals.
    void name_state(const plan::Reading& reading, const std::string& name,
                    Names::OfReading& names) {
        if (reading.kind == plan::Reading::Kind::pending) {
            name_pending(reading.pending, name, names);
        } else {
            name_registers(plan::members_of(reading), name, names);
            for (const std::string& suffix : reading.straight.locals)
                names.locals.push_back(local(judge_, name + suffix));
        }
        if (plan::table_of(reading) == nullptr) return;
        names.guards = local(judge_, name + "_guards");
        names.weak = local(judge_, name + "_weak");
        names.strong = local(judge_, name + "_strong");
    }

    /// Names registers. Those with the same suffix are an array.
    void name_registers(const std::vector<plan::Member>& kept, const std::string& name,
                        Names::OfReading& names) {
        std::map<std::string, std::vector<std::size_t>> by_suffix;
        for (std::size_t i = 0; i < kept.size(); ++i) by_suffix[kept[i].suffix].push_back(i);
        names.members.resize(kept.size());
        names.elements.resize(kept.size(), plan::kNone);
        for (const auto& [suffix, indices] : by_suffix) {
            const std::string claimed = member(members_, name + suffix);
            for (std::uint32_t n = 0; n < indices.size(); ++n) {
                names.members[indices[n]] = claimed;
                if (indices.size() > 1) names.elements[indices[n]] = n;
            }
        }
    }

    void name_pending(const plan::Pending& pending, const std::string& name,
                      Names::OfReading& names) {
        for (const plan::Pending::Part& part : pending.parts) {
            const std::string words = identifier(graph_.short_text(part.node), "");
            names.parts.push_back(local(judge_, (words.empty() ? name : words) + "_last"));
            if (part.leaf == plan::kNone) continue;
            names.members.push_back(
                member(members_, fmt::format("{}_last_{}", name, words.empty() ? "value" : words)));
        }
        names.count = local(judge_, name + "_count");
        names.members.push_back(member(members_, name));
        if (pending.is_fold) names.members.push_back(member(members_, name + "_guard"));
    }

    void name_numbers() {
        Scope scope;
        const auto name = [&](const check::Expr& expression, const std::string& of) {
            check::for_each_of_step(expression, [&](const check::Expr& e) {
                if (e.kind == check::Expr::Kind::number)
                    names_.number_constant[&e] = scope.number(of);
            });
        };
        for (check::Index p : plan_.predicates)
            name(model_.predicates[p].expression, names_.predicate_atom[p]);
        for (check::Index p : plan_.pasts) name(model_.pasts[p].expression, names_.past_local[p]);
    }

    void name_constants() {
        if (model_.retargetable) name_numbers();
        std::map<std::pair<check::Index, bool>, std::string> arrays;
        std::map<std::string, std::string> narrow_arrays;
        for (check::Index d : plan_.distances) {
            const check::Distance& distance = model_.distances[d];
            if (distance.is_between_points()) {
                if (!distance.weights.empty())
                    names_.weight_array[d] = constants_.claim("between_points_weights");
                continue;
            }
            const bool as_given = plan::rows_as_given(distance);
            const std::string target = array_name(model_.targets[distance.target]);
            auto [entry, added] = arrays.try_emplace({distance.target, as_given});
            if (added) entry->second = constants_.claim(as_given ? target : target + "_unit");
            names_.target_array[d] = entry->second;
            if (plan::searches(plan_, d))
                names_.search_member[d] = member(members_, target + "_search");
            if (const plan::NarrowSet* set = plan::narrow_set(plan_, d)) {
                auto [at, first] = narrow_arrays.try_emplace(entry->second);
                if (first)
                    at->second = constants_.claim(entry->second + "_" + plan::word(set->storage));
                names_.narrow_array[d] = at->second;
            }
            if (!distance.weights.empty())
                names_.weight_array[d] = constants_.claim(target + "_weights");
        }
        for (check::Index p : plan::projected_points(model_, plan_.distances))
            name_projection(model_.points[p].projection);
    }

    /// Returns "anchors", or "anchors_in_Q_z" for rows that were projected at compile time.
    std::string array_name(const check::Target& target) const {
        if (target.source == check::kNone) return target.name;
        return target.name + "_in_" + identifier(model_.points[target.space].text, "projected");
    }

    /// Names a projection, which has its own namespace.
    void name_projection(check::Index index) {
        if (names_.matrix_array.count(index) != 0) return;
        const check::Projection& projection = model_.projections[index];
        names_.matrix_array[index] = projections_.claim(projection.name);
        if (!projection.offset.empty())
            names_.offset_array[index] = projections_.claim(projection.name + "_offset");
    }

    const plan::Plan& plan_;
    const check::Model& model_;
    const ir::Graph& graph_;
    std::vector<const plan::Monitor*> monitor_of_ = first_monitors();  ///< per reading
    Names names_;
    bool on_demand_;
    Scope judge_;
    Scope measure_scope_;
    Scope& measure_;  ///< a Boolean monitor has one function with all locals
    Scope atoms_;
    Scope members_{{"answers_", "deciding_", "finishes_", "incomplete_", "measured_", "numbers_",
                    "position_", "recorder_", "rows_"}};  // reserved for the class itself
    Scope constants_;
    Scope projections_;
};

}  // namespace

Names make_names(const plan::Plan& plan) {
    return Naming(plan).name_all();
}

const Spelling& spelling(check::Values values) {
    static const Spelling kRobustness{
        .value = "etlmon::Value",
        .value_meaning = "a robustness; low and high differ where a sample is missing",
        .atom = "Value",
        .key = "etlmon::Key",
        .reading = "etlmon::Reading",
        .verdict = "etlmon::Verdict",
        .kept = "etlmon::Register",
        .bytes = false,
        .yes = "etlmon::kTrue",
        .no = "etlmon::kFalse",
        .top = "etlmon::kTop",
        .bottom = "etlmon::kBottom",
        .neither = "",
        .predicates = "temporal/predicate",
        .verdicts = "temporal/verdict",
        .delays = "temporal/delay",
        .windows = "temporal/window",
    };
    static const Spelling kTruth{
        .value = "etlmon::Truth",
        .value_meaning = "two bits: surely true, possibly true",
        .atom = "Value",
        .key = "bool",
        .reading = "etlmon::BasicReading<Value>",
        .verdict = "etlmon::BooleanVerdict",
        .kept = "Value",
        .bytes = true,
        .yes = "etlmon::kYes",
        .no = "etlmon::kNo",
        .top = "true",
        .bottom = "false",
        .neither = "etlmon::kPerhaps",
        .predicates = "temporal/demand",
        .verdicts = "temporal/boolean_verdict",
        .delays = "temporal/boolean_window",
        .windows = "temporal/boolean_window",
    };
    static const Spelling kSourced{
        .value = "etlmon::Sourced",
        .value_meaning = "a robustness with its sample; low and high differ where one is missing",
        .atom = "etlmon::Value",
        .key = "etlmon::SourcedKey",
        .reading = "etlmon::BasicReading<Value>",
        .verdict = "etlmon::Verdict",
        .kept = "etlmon::SourcedRegister",
        .bytes = false,
        .yes = "etlmon::kTrueItself",
        .no = "etlmon::kFalseItself",
        .top = "etlmon::kTop",
        .bottom = "etlmon::kBottom",
        .neither = "",
        .predicates = "temporal/predicate",
        .verdicts = "temporal/samples",
        .delays = "temporal/delay",
        .windows = "temporal/window",
    };
    switch (values) {
        case check::Values::robustness: break;
        case check::Values::boolean: return kTruth;
        case check::Values::sourced: return kSourced;
    }
    return kRobustness;
}

}  // namespace etlc::emit
