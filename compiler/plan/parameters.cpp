#include "plan/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <set>

#include "check/model/fingerprint.hpp"
#include "data/files/hash.hpp"
#include "plan/targets/kernels.hpp"

namespace etlc::plan {

namespace {

using Kind = Parameter::Kind;
using etlmon::ParamsPart;

constexpr std::uint32_t kLineFloats = etlmon::detail::kParamsAlignment / sizeof(float);

std::uint32_t whole_lines(std::uint32_t floats) {
    return (floats + kLineFloats - 1) / kLineFloats * kLineFloats;
}

class Listing {
public:
    explicit Listing(const Plan& plan) : plan_(plan), model_(*plan.model) {}

    std::vector<Parameter> list() {
        for (const Index p : plan_.predicates) add_scalars(p);
        for (const Index p : plan_.pasts) add_numbers(Kind::in_past, p, model_.pasts[p].expression);
        for (const Index d : plan_.distances) add_distance(d);
        for (const Index p : projected_points(model_, plan_.distances))
            add_projection(model_.points[p].projection);
        return std::move(list_);
    }

private:
    void add_scalars(Index p) {
        const check::Predicate& predicate = model_.predicates[p];
        const bool of_two = predicate.threshold.inner.has_value();
        add({.kind = Kind::threshold,
             .index = p,
             .count = of_two ? 2U : 1U,
             .rule = of_two                       ? ParamsPart::ascending
                     : predicate.plain_distance() ? ParamsPart::not_negative
                                                  : ParamsPart::any});
        add_numbers(Kind::number, p, predicate.expression);
    }

    void add_numbers(Kind kind, Index index, const check::Expr& expression) {
        check::for_each_of_step(expression, [&](const check::Expr& e) {
            if (e.kind == check::Expr::Kind::number)
                add({.kind = kind, .index = index, .number = &e});
        });
    }

    void add_distance(Index d) {
        const check::Distance& distance = model_.distances[d];
        const std::uint32_t dimension = model_.dimension_of(d);
        const bool as_given = rows_as_given(distance);
        if (!distance.is_between_points() && done_.emplace(distance.target, as_given).second)
            add_array({.kind = Kind::rows,
                       .index = d,
                       .count = model_.rows_of(d) * dimension,
                       .width = dimension,
                       .rule = as_given ? ParamsPart::any : ParamsPart::unit_rows});
        if (distance.weights.empty()) return;
        add_array({.kind = Kind::weights,
                   .index = d,
                   .count = static_cast<std::uint32_t>(distance.weights.size()),
                   .width = dimension,
                   .rule = distance.full_weights() ? ParamsPart::symmetric : ParamsPart::positive});
    }

    void add_projection(Index index) {
        if (!projections_.insert(index).second) return;
        const check::Projection& map = model_.projections[index];
        add_array({.kind = Kind::matrix,
                   .index = index,
                   .count = static_cast<std::uint32_t>(map.matrix.size()),
                   .width = map.dimension});
        if (!map.offset.empty())
            add_array({.kind = Kind::offset,
                       .index = index,
                       .count = map.dimension,
                       .width = map.dimension});
    }

    void add_array(Parameter parameter) {
        end_ = whole_lines(end_);
        add(parameter);
    }

    void add(Parameter parameter) {
        parameter.begin = end_;
        end_ += parameter.count;
        list_.push_back(parameter);
    }

    const Plan& plan_;
    const check::Model& model_;
    std::set<std::pair<Index, bool>> done_;  ///< targets done, as given or normalised
    std::set<Index> projections_;
    std::vector<Parameter> list_;
    std::uint32_t end_ = sizeof(etlmon::detail::ParamsHead) / sizeof(float);
};

std::vector<float> values_of(const check::Model& model, const Parameter& parameter) {
    switch (parameter.kind) {
        case Kind::threshold: {
            const check::Range range = model.predicates[parameter.index].threshold.range();
            if (parameter.count == 2) return {range.low, range.high};
            return {range.high};
        }
        case Kind::number:
        case Kind::in_past: return {parameter.number->number32};
        case Kind::rows: return prepared_rows(model, model.distances[parameter.index]);
        case Kind::weights: return model.distances[parameter.index].weights;
        case Kind::matrix: return model.projections[parameter.index].matrix;
        case Kind::offset: break;
    }
    return model.projections[parameter.index].offset;
}

/// Appends a number to the block, lowest byte first.
template <class Number>
void put(std::string& bytes, std::size_t at, Number number) {
    for (std::size_t i = 0; i < sizeof number; ++i)
        bytes[at + i] = static_cast<char>(static_cast<std::uint64_t>(number) >> (8 * i));
}

}  // namespace

std::vector<Parameter> parameters(const Plan& plan) {
    return Listing(plan).list();
}

std::uint64_t block_bytes(const std::vector<Parameter>& parameters) {
    const std::uint32_t end = parameters.empty()
                                  ? sizeof(etlmon::detail::ParamsHead) / sizeof(float)
                                  : parameters.back().begin + parameters.back().count;
    return std::uint64_t{whole_lines(end)} * sizeof(float);
}

std::uint64_t encoder_hash(const check::Model& model) {
    std::string lines;
    for (const check::Encoder& encoder : model.encoders)
        lines += fmt::format("{} {}\n", encoder.name, encoder.fingerprint);
    return lines.empty() ? 0 : data::xxh64(lines);
}

std::string block(const Plan& plan, std::uint64_t shape) {
    using Head = etlmon::detail::ParamsHead;
    const std::vector<Parameter> list = parameters(plan);
    std::string bytes(block_bytes(list), '\0');
    for (const Parameter& parameter : list) {
        const std::vector<float> values = values_of(*plan.model, parameter);
        assert(values.size() == parameter.count);
        for (std::size_t i = 0; i < values.size(); ++i)
            put(bytes, (parameter.begin + i) * sizeof(float),
                std::bit_cast<std::uint32_t>(values[i]));
    }
    const check::Fingerprint made_from = check::fingerprint(*plan.model);
    std::memcpy(bytes.data(), etlmon::detail::kParamsMagic, sizeof etlmon::detail::kParamsMagic);
    put(bytes, offsetof(Head, version), etlmon::detail::kParamsVersion);
    put(bytes, offsetof(Head, size), static_cast<std::uint32_t>(bytes.size()));
    put(bytes, offsetof(Head, shape), shape);
    put(bytes, offsetof(Head, encoder), encoder_hash(*plan.model));
    put(bytes, offsetof(Head, spec), made_from.spec);
    put(bytes, offsetof(Head, data), made_from.data);
    put(bytes, offsetof(Head, thresholds), made_from.thresholds);
    put(bytes, offsetof(Head, checksum),
        etlmon::detail::params_checksum(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                        bytes.size()));
    return bytes;
}

}  // namespace etlc::plan
