#include "plan/program/sample_codes.hpp"

#include <algorithm>

#include "etlmon/temporal/samples.hpp"

namespace etlc::plan {

namespace {

std::size_t declared_at(const check::Model& model, const Samples::Place& place) {
    return place.is_predicate ? model.predicates[place.index].span.begin
                              : model.inputs[place.index].span.begin;
}

std::uint32_t rows_of(const check::Model& model, Index predicate) {
    const check::Predicate& of = model.predicates[predicate];
    if (!of.plain_distance()) return 0;
    const Index distance = of.expression.index;
    return model.distances[distance].is_between_points() ? 0 : model.rows_of(distance);
}

std::uint64_t codes_of(const std::vector<Samples::Place>& places) {
    std::uint64_t codes = 0;
    for (const Samples::Place& place : places) codes += place.codes();
    return codes;
}

/// Drops the rows of the largest sets where there are too many codes.
void leave_out_rows(std::vector<Samples::Place>& places) {
    const auto most = [](const Samples::Place& a, const Samples::Place& b) {
        return a.rows < b.rows;
    };
    while (codes_of(places) > etlmon::Ranks<1>::kLastStep / Samples::kSteps) {
        const auto largest = std::max_element(places.begin(), places.end(), most);
        if (largest->rows == 0) return;
        largest->rows = 0;
    }
}

}  // namespace

const Samples::Place& Samples::place_of(bool is_predicate, Index index) const {
    return *std::find_if(places.begin(), places.end(), [&](const Place& of) {
        return of.is_predicate == is_predicate && of.index == index;
    });
}

Samples samples(const Plan& plan) {
    const check::Model& model = *plan.model;
    Samples result;
    for (const Index p : plan.predicates) result.places.push_back({true, p, rows_of(model, p)});
    for (const Index i : plan.inputs)
        if (model.inputs[i].type == check::InputType::boolean) result.places.push_back({false, i});
    std::stable_sort(result.places.begin(), result.places.end(), [&](const auto& a, const auto& b) {
        return declared_at(model, a) < declared_at(model, b);
    });
    leave_out_rows(result.places);
    for (Samples::Place& place : result.places) {
        place.first = result.codes;
        result.codes += place.codes();
    }
    return result;
}

std::uint64_t bytes_of(const Samples& samples, std::size_t monitors) {
    constexpr std::uint64_t kStep = 4;  // the current one of measure()
    return samples.places.empty() ? 0 : kStep + monitors * sizeof(etlmon::SourcedKey);
}

}  // namespace etlc::plan
