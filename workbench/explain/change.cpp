// Finds the smallest change of one measurement that flips a verdict. Candidates are the points at
// which a literal changes its truth, tried in order of size: by bisection over the floats for an
// order comparison, at and beside the threshold for == and !=.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "explain/support.hpp"

namespace etlc::explain {

namespace {

using etlmon::Key;

class Search {
public:
    Search(const Subject& subject, Judged& judged)
        : subject_(subject), judged_(judged), status_(judged.status) {}

    std::optional<Change> among(const std::vector<Sample>& samples) {
        const Key weakest = status_ == Status::satisfied ? etlmon::kBottom : etlmon::kTop;
        Support support(subject_, judged_, weakest);
        std::set<std::pair<std::uint64_t, Index>> seen;  // step and first atom
        for (const Sample& sample : samples) {
            if (subject_.observations.is_missing(sample)) continue;
            const std::vector<Index> atoms = of_same_measurement(sample.atom);
            if (!seen.insert({sample.step, atoms.front()}).second) continue;
            add_candidates(sample, atoms, support);
        }
        std::stable_sort(candidates_.begin(), candidates_.end(),
                         [](const Candidate& a, const Candidate& b) { return a.size < b.size; });
        for (const Candidate& candidate : candidates_) {
            if (!turns(candidate.altered)) continue;
            const Judged then = judge(subject_, &candidate.altered);
            return Change{candidate.sample, candidate.altered.measured, then.status,
                          then.reading == Reading::for_good};
        }
        return std::nullopt;
    }

private:
    struct Candidate {
        double size = 0;
        Sample sample;
        Altered altered;
    };

    /// Returns whether the status is lost; of a verdict that is final, whether finality is.
    bool turns(const Altered& altered) {
        const Bounds root = judged_.values.at_with(altered, subject_.root, subject_.position);
        return !subject_.supports(status_, judged_.deciding(root).key);
    }

    /// Returns the atoms that compare the same distance or expression, or read the same bool.
    std::vector<Index> of_same_measurement(Index atom) {
        const Observations& observed = subject_.observations;
        if (expressions_.empty())
            for (Index a = 0; a < observed.atoms().size(); ++a)
                expressions_.push_back(
                    observed.atoms()[a].is_predicate
                        ? check::print(observed.model(), observed.predicate(a).expression)
                        : "");
        if (!observed.atoms()[atom].is_predicate) return {atom};
        std::vector<Index> result;
        for (Index a = 0; a < expressions_.size(); ++a)
            if (expressions_[a] == expressions_[atom]) result.push_back(a);
        return result;
    }

    /// Adds the points at which a literal stops supporting the status. A literal of == or != may
    /// start to support it on the way, so all of its points are tried.
    void add_candidates(Sample sample, const std::vector<Index>& atoms, Support& support) {
        const Observations& observed = subject_.observations;
        const float measured = observed.measured(sample);
        if (!observed.atoms()[sample.atom].is_predicate) {
            add({kInfinity, sample, {sample.step, atoms, measured != 0 ? 0.0F : 1.0F}}, support);
            return;
        }
        std::set<float> tried;
        const auto try_with = [&](float other) {
            if (other == measured || !tried.insert(other).second) return;
            const double size = static_cast<double>(other) - static_cast<double>(measured);
            add({std::abs(size), sample, {sample.step, atoms, other}}, support);
        };
        for (const Index atom : atoms) {
            if (observed.predicate(atom).equality()) {
                for (const float other : points_of_equality(atom)) try_with(other);
                continue;
            }
            for (const NodeId literal : support.literals({atom, sample.step}))
                for (const bool up : {false, true})
                    if (const auto other = turning_point(literal, atom, measured, up))
                        try_with(*other);
        }
    }

    /// Returns the threshold, where == holds alone, and the floats beside it, as far as the range
    /// of the expression allows.
    std::vector<float> points_of_equality(Index atom) const {
        constexpr float kEnd = std::numeric_limits<float>::infinity();
        const check::Predicate& predicate = subject_.observations.predicate(atom);
        const float threshold = predicate.threshold.value + 0.0F;  // turns -0 into 0
        std::vector<float> points;
        for (const float point :
             {threshold, std::nextafter(threshold, -kEnd), std::nextafter(threshold, kEnd)})
            if (std::isfinite(point) && predicate.delta.contains(point)) points.push_back(point);
        return points;
    }

    /// Adds a candidate, unless the status holds without the literals that it falsifies.
    void add(Candidate candidate, Support& support) {
        std::vector<Evidence> lost;
        for (const Index atom : candidate.altered.atoms)
            for (const NodeId literal : support.literals({atom, candidate.sample.step}))
                if (!supports(literal, atom, candidate.altered.measured))
                    lost.push_back({literal, candidate.sample.step});
        if (support.needs(lost)) candidates_.push_back(std::move(candidate));
    }

    bool supports(NodeId literal, Index atom, float measured) const {
        const etlmon::Value value = subject_.observations.value(atom, measured);
        return subject_.supports(status_, subject_.graph[literal].negated ? -value.low : value.low);
    }

    /// Returns the first number above or below at which the literal no longer supports the status.
    std::optional<float> turning_point(NodeId literal, Index atom, float measured, bool up) const {
        const auto still = [&](std::int64_t delta) {
            return supports(literal, atom, etlmon::float_of(static_cast<Key>(delta)));
        };
        const check::Range& range = subject_.observations.predicate(atom).delta;
        constexpr float kGreatest = std::numeric_limits<float>::max();
        std::int64_t other =
            etlmon::key_of(up ? std::min(range.high, kGreatest) : std::max(range.low, -kGreatest));
        std::int64_t same = etlmon::key_of(measured);
        if ((up ? other <= same : other >= same) || still(other)) return std::nullopt;
        while (std::abs(other - same) > 1) {
            const std::int64_t middle = same + (other - same) / 2;
            (still(middle) ? same : other) = middle;
        }
        return etlmon::float_of(static_cast<Key>(other));
    }

    static constexpr double kInfinity = std::numeric_limits<double>::infinity();

    const Subject& subject_;
    Judged& judged_;
    Status status_;
    std::vector<std::string> expressions_;  ///< per atom
    std::vector<Candidate> candidates_;
};

}  // namespace

std::optional<Change> smallest_change(const Subject& subject, Judged& judged,
                                      const std::vector<Sample>& samples) {
    return Search(subject, judged).among(samples);
}

}  // namespace etlc::explain
