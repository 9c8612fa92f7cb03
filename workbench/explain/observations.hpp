// What the predicates and bools of a spec came to at every step of a recording.
// Takes: an evaluator of plan() after each step. Gives: their values by atom and step. Keeps true:
// atoms are numbered in the order in which the spec first says them; a missing sample has the value
// that the whole range is.
#pragma once

#include <cstdint>
#include <vector>

#include "check/model/model.hpp"
#include "etlmon/temporal/value.hpp"
#include "plan/evaluate/evaluator.hpp"
#include "plan/plan.hpp"

namespace etlc::explain {

using check::Index;

/// What a formula is made of: a predicate, or a bool input.
struct Atom {
    bool is_predicate = true;
    Index index = 0;  ///< of the model's predicates, or of its inputs
};

/// An atom, by number, at a step.
struct Sample {
    Index atom = 0;
    std::uint64_t step = 0;

    bool operator==(const Sample&) const = default;
};

class Observations {
public:
    /// Of these predicates, and of the bools among these inputs; other atoms are never looked at.
    Observations(const check::Model& model, check::Values values,
                 const std::vector<Index>& predicates, const std::vector<Index>& inputs);

    const check::Model& model() const { return model_; }
    const std::vector<Atom>& atoms() const { return atoms_; }
    /// The number of a predicate or of a bool input.
    Index atom(bool is_predicate, Index index) const;
    /// The predicate of an atom that is one.
    const check::Predicate& predicate(Index atom) const;
    bool is_looked_at(Index atom) const { return columns_[atom].is_looked_at; }

    /// It measures the predicates, and takes the bools.
    const plan::Plan& plan() const { return plan_; }
    void add(const plan::Evaluator& evaluator);
    /// Room for so many steps, so that add() asks for no memory until then.
    void reserve(std::uint64_t steps);
    /// From here on there were no steps.
    void clear();
    std::uint64_t steps() const { return steps_; }

    /// The distance or expression of a predicate; of a bool 0 or 1. NaN: missing.
    float measured(Sample sample) const { return columns_[sample.atom].measured[sample.step]; }
    bool is_missing(Sample sample) const;
    /// Of a predicate's n-th distance the row that was nearest.
    std::uint32_t nearest(Sample sample, std::size_t n) const {
        return columns_[sample.atom].nearest[n][sample.step];
    }

    /// What the atom is worth to a formula where that is measured; NaN: what a missing sample
    /// counts as.
    etlmon::Value value(Index atom, float measured) const;
    etlmon::Value value(Sample sample) const { return value(sample.atom, measured(sample)); }
    /// What it is worth where nothing is known of it.
    etlmon::Value range(Index atom) const;

private:
    struct Column {
        bool is_looked_at = false;
        std::vector<Index> distances;  ///< of its predicate
        std::vector<float> measured;
        std::vector<std::vector<std::uint32_t>> nearest;  ///< per distance, per step
    };

    const check::Model& model_;
    check::Values values_;
    plan::Plan plan_;
    std::vector<Atom> atoms_;
    std::vector<Index> of_predicates_;  ///< per predicate, its atom
    std::vector<Index> of_inputs_;
    std::vector<Column> columns_;  ///< per atom
    std::uint64_t steps_ = 0;
};

}  // namespace etlc::explain
