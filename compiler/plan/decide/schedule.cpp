#include "plan/decide/schedule.hpp"

#include <algorithm>
#include <iterator>

namespace etlc::plan {

namespace {

template <class Visit>
void for_each_variable(const Term& term, const Visit& visit) {
    if (term.kind == Term::Kind::reg || term.kind == Term::Kind::local) visit(term);
    for (const Term& operand : term.operands) for_each_variable(operand, visit);
}

template <class Times>
std::size_t known(const Times& times, const Term& variable) {
    const auto found = times.find({variable.kind, variable.index});
    return found == times.end() ? 0 : found->second;
}

}  // namespace

Schedule::Schedule(std::vector<Assignment> assignments) : steps_(std::move(assignments)) {
    stores_.resize(steps_.size() + 1);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        for_each_variable(steps_[i].value, [&](const Term& read) { read_by(read, i + 1); });
        assigned_at_[{steps_[i].target, steps_[i].index}] = i + 1;
    }
}

void Schedule::read_by(const Term& variable, std::size_t time) {
    std::size_t& until = read_until_[{variable.kind, variable.index}];
    until = std::max(until, time);
}

void Schedule::add(const Term& to, Term value) {
    Assignment store{.target = to.kind, .index = to.index, .value = std::move(value)};
    std::size_t at = std::max(known(read_until_, to), known(assigned_at_, to));
    for_each_variable(store.value,
                      [&](const Term& read) { at = std::max(at, known(assigned_at_, read)); });
    for_each_variable(store.value, [&](const Term& read) { read_by(read, at); });
    stores_[at].push_back(std::move(store));
}

std::vector<Assignment> Schedule::end() {
    std::vector<Assignment> result = std::move(stores_[0]);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        result.push_back(std::move(steps_[i]));
        std::move(stores_[i + 1].begin(), stores_[i + 1].end(), std::back_inserter(result));
    }
    return result;
}

}  // namespace etlc::plan
