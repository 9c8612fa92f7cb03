#include "reference/explanation.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace etlc::reference {
namespace {

/// "satisfied where rho >= 0, violated where rho_high < 0, else unknown"
Status status_of(const Value& value) {
    if (value.rho >= 0) return Status::satisfied;
    return value.rho_high < 0 ? Status::violated : Status::unknown;
}

/// "Of two equal values that of the earlier sample counts as farther from zero, and a zero as
/// positive; a negation turns the order around": less is less.
using Ordered = std::pair<double, std::pair<int, Sample>>;

struct Less {
    bool operator()(const Ordered& a, const Ordered& b) const {
        if (a.first != b.first) return a.first < b.first;
        const auto& [sign_a, sample_a] = a.second;
        const auto& [sign_b, sample_b] = b.second;
        if (sign_a != sign_b) return sign_a < sign_b;
        return sign_a > 0 ? sample_b < sample_a : sample_a < sample_b;
    }
};

}  // namespace

Explained::Explained(const check::Model& model, const Trace& trace, check::Values values,
                     Index monitor, std::uint64_t position, std::uint64_t step)
    : model_(model),
      trace_(trace),
      values_(values),
      form_(normal_form(model)),
      literals_(literals(model, trace, values)),
      root_(form_.roots[monitor]),
      position_(position),
      step_(step),
      status_(status_of(value(literals_))) {}

Value Explained::value(const Literals& literals) const {
    return Prefix(form_, literals, step_).at(root_, position_);
}

Sample Explained::sample(const Node& literal, std::uint64_t step) const {
    const bool is_predicate = literal.kind == Node::Kind::predicate;
    const check::Span span =
        is_predicate ? model_.predicates[literal.index].span : model_.inputs[literal.index].span;
    return {step, span.begin, is_predicate, literal.index};
}

Status Explained::status_with_only(const SampleSet& known) const {
    Literals literals = literals_;
    for (std::size_t n = 0; n < form_.nodes.size(); ++n) {
        if (!form_.nodes[n].is_atom()) continue;
        const Unseen& range = literals.ranges[n];
        for (std::uint64_t step = 0; step <= step_; ++step)
            if (!known.contains(sample(form_.nodes[n], step)))
                literals.values[n][step] = {range.lowest, range.lowest, range.highest,
                                            range.highest};
    }
    return status_of(value(literals));
}

Status Explained::status_with(const std::vector<Alteration>& alterations) const {
    return status_of(value(literals(model_, trace_, values_, alterations)));
}

/// Every value of a literal gets a number of its own, in their order: rho is then the number of the
/// sample that it is the value of.
std::optional<Sample> Explained::critical() const {
    const bool low = status_ == Status::satisfied;
    std::map<Ordered, double, Less> numbers;
    const auto ordered = [&](std::size_t n, std::uint64_t step) {
        const Value& v = literals_.values[n][step];
        const double value = low ? v.rho : v.rho_high;
        const bool negated = form_.nodes[n].negated;
        const int sign = (negated ? -value : value) < 0 ? -1 : 1;
        return Ordered{value, {negated ? -sign : sign, sample(form_.nodes[n], step)}};
    };
    const auto for_each = [&](const auto& visit) {
        for (std::size_t n = 0; n < form_.nodes.size(); ++n)
            for (std::uint64_t step = 0; step <= step_ && form_.nodes[n].is_atom(); ++step)
                visit(n, step);
    };
    for_each([&](std::size_t n, std::uint64_t step) { numbers.emplace(ordered(n, step), 0); });
    double next = 0;
    for (auto& [value, number] : numbers) number = next++;
    Literals literals = literals_;
    for_each([&](std::size_t n, std::uint64_t step) {
        const double number = numbers.at(ordered(n, step));
        literals.values[n][step] = {number, number, number, number};
    });
    const double rho = value(literals).rho;
    for (const auto& [value, number] : numbers)
        if (number == rho) return value.second.second;
    return std::nullopt;
}

SampleSet Explained::explanation() const {
    const Value rho = value(literals_);
    SampleSet kept;
    for (std::size_t n = 0; n < form_.nodes.size(); ++n)
        for (std::uint64_t step = 0; step <= step_ && form_.nodes[n].is_atom(); ++step) {
            const Value& v = literals_.values[n][step];
            const bool is_known = v.rho == v.rho_high;
            const bool supports =
                status_ == Status::satisfied ? v.rho >= rho.rho : v.rho_high <= rho.rho_high;
            if (is_known && supports) kept.insert(sample(form_.nodes[n], step));
        }
    std::vector<Sample> order(kept.rbegin(), kept.rend());
    const std::optional<Sample> last = critical();
    std::stable_partition(order.begin(), order.end(), [&](const Sample& s) { return s != last; });
    for (const Sample& candidate : order) {
        kept.erase(candidate);
        if (status_with_only(kept) != status_) kept.insert(candidate);
    }
    return kept;
}

}  // namespace etlc::reference
