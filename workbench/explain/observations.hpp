// Measurements of the predicates and bools of a spec at every step of a recording. Atoms are
// numbered in the order in which the spec first mentions them; a missing sample has the whole range
// as its value.
#pragma once

#include <cstdint>
#include <vector>

#include "check/model/model.hpp"
#include "etlmon/temporal/value.hpp"
#include "execute/evaluator.hpp"
#include "plan/plan.hpp"

namespace etlc::explain {

using check::Index;

/// An atom of formulas: a predicate, or a bool input.
struct Atom {
    bool is_predicate = true;
    Index index = 0;  ///< of the model's predicates, or of its inputs
};

/// An atom at a step.
struct Sample {
    Index atom = 0;
    std::uint64_t step = 0;

    bool operator==(const Sample&) const = default;
};

class Observations {
public:
    /// Observes these predicates, and the bools among these inputs; no others are read.
    Observations(const check::Model& model, check::Values values,
                 const std::vector<Index>& predicates, const std::vector<Index>& inputs);

    const check::Model& model() const { return model_; }
    const std::vector<Atom>& atoms() const { return atoms_; }
    /// Returns the number of a predicate or of a bool input.
    Index atom(bool is_predicate, Index index) const;
    /// Returns the predicate of an atom that is one.
    const check::Predicate& predicate(Index atom) const;
    bool is_looked_at(Index atom) const { return columns_[atom].is_looked_at; }

    /// The plan that measures the predicates and reads the bools.
    const plan::Plan& plan() const { return plan_; }
    void add(const execute::Evaluator& evaluator);
    /// Reserves memory for `steps` steps; until then add() allocates none.
    void reserve(std::uint64_t steps);
    /// Discards all steps.
    void clear();
    std::uint64_t steps() const { return steps_; }
    /// Takes the steps of other observations of the same predicates and inputs.
    void take(const Observations& other);
    /// Passes the steps to an archive (execute/archive.hpp).
    template <class Self, class Archive>
    static void visit(Self& self, Archive& archive) {
        archive.number(self.steps_);
        for (auto& column : self.columns_) {
            archive.some(column.measured);
            for (auto& rows : column.nearest) archive.some(rows);
        }
    }
    /// Returns whether there are as many steps in all columns.
    bool fits(std::uint64_t steps) const;

    /// Returns the distance or expression of a predicate, 0 or 1 of a bool; NaN where missing.
    float measured(Sample sample) const { return columns_[sample.atom].measured[sample.step]; }
    bool is_missing(Sample sample) const;
    /// Returns whether a known number lies between two thresholds.
    bool is_between(Sample sample) const;
    /// Returns the nearest row of a predicate's n-th distance.
    std::uint32_t nearest(Sample sample, std::size_t n) const {
        return columns_[sample.atom].nearest[n][sample.step];
    }

    /// Returns the value of the atom for a measurement; NaN stands for a missing sample.
    etlmon::Value value(Index atom, float measured) const;
    etlmon::Value value(Sample sample) const { return value(sample.atom, measured(sample)); }
    /// Returns the value of the atom at an unseen step.
    etlmon::Value range(Index atom) const;

private:
    struct Column {
        bool is_looked_at = false;
        std::vector<Index> distances;  ///< of the predicate
        std::vector<float> measured;
        std::vector<std::vector<std::uint32_t>> nearest;  ///< per distance, per step
    };

    const check::Model& model_;
    check::Values values_;
    plan::Plan plan_;
    std::vector<Atom> atoms_;
    std::vector<Index> of_predicates_;  ///< atom of each predicate
    std::vector<Index> of_inputs_;
    std::vector<Column> columns_;  ///< per atom
    std::uint64_t steps_ = 0;
};

}  // namespace etlc::explain
