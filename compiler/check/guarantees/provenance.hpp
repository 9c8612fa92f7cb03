// What a calibrated threshold depends on, besides the demonstrations.
// Takes: a predicate of the model. Gives: the texts and hashes that `etlc calibrate` writes beside
// its epsilon and that check/ compares when it reads one back. Keeps true: two specs with equal
// provenance ask for the same threshold from the same demonstrations. `reads` alone sees to that;
// the others say in the words of the spec what has changed.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

/// For each thing that scores or frames are computed from, by kind and name ("input z"), a
/// canonical text: two models with equal texts make the same of the same episodes. Every struct of
/// the model is taken apart into all its fields, so a new field does not compile before somebody
/// has said whether it counts.
using Reads = std::map<std::string, std::string>;

/// Of its threshold: the threshold itself and `missing` are not read by it.
Reads reads(const Model& model, Index predicate);
/// Of its shift: the monitor without it, beside the same formula over the truths.
Reads reads(const Model& model, const Monitor& monitor);
Reads reads(const Model& model, const Fitted& fitted);

/// What differs between two of them, a sentence each: "predicate a was: x <= 0.5; it is: x <= 1".
std::vector<std::string> differences(const Reads& then, const Reads& now);

struct Provenance {
    std::string predicate;  ///< canonical text without the threshold
    std::string truth;  ///< canonical text of the truth formula, its predicates and lets written
                        ///< out; empty: none
    /// Content hashes: of every target that the predicate measures against, by its name; of the
    /// weights of a mahalanobis distance, by the distance's text; of what an input's declaration
    /// makes of its samples (float16 or int8, its scale, range and hold), by the input's name,
    /// where it takes them as they are not; and fingerprints of encoders that make inputs.
    std::map<std::string, std::string> targets;
    /// The same of what the truth formula measures and reads.
    std::map<std::string, std::string> truth_targets;
    Reads reads;
};

/// Where labels came from: in how many of the episodes those of a predicate are of an array.
struct Labelling {
    std::size_t episodes = 0;
    std::map<Index, std::size_t> from_arrays;
};

/// `truth` as an entry has it: the text of the truth in the spec; "array" without one; "array in
/// place of TEXT" or, in some of the episodes, "array or TEXT".
std::string labels(const std::string& truth, Index predicate, const Labelling& labelling);
/// The other way: what the spec said; empty where it said nothing.
std::string stated(std::string labels);

Provenance provenance(const Model& model, Index predicate);

/// The same of a calibrated monitor: `predicate` is its formula with the predicates and their
/// thresholds written out, `truth` says of each what its labels are, `targets` are all that either
/// measures.
Provenance provenance(const Model& model, const Monitor& monitor, const Labelling& labelling = {});

/// What something is fitted to, besides the demonstrations: what `etlc fit` writes and check/
/// compares.
struct FittedProvenance {
    std::string of;  ///< "Q(z), Q = 0123456789abcdef": the point, and the maps that it goes through
    std::string truth;  ///< `where`, the labels of its predicates and what they measure; or "true"
    Reads reads;
};
FittedProvenance provenance(const Model& model, const Fitted& fitted,
                            const Labelling& labelling = {});

/// The predicates in a formula, ascending.
std::vector<Index> predicates_of(const Model& model, Index formula);

}  // namespace etlc::check
