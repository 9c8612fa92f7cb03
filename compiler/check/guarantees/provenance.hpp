// The texts and hashes that a calibrated threshold or a fitted element depends on besides the
// demonstrations. `etlc calibrate` and `etlc fit` write them and check/ compares them. Two specs
// with equal `reads` need the same threshold from the same demonstrations; the other fields
// describe differences in the words of the spec.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

/// A canonical text for each thing that scores or frames are computed from, by kind and name
/// ("input z"). Models with equal texts compute the same from the same episodes. reads.cpp
/// decomposes every struct of the model, so it does not compile until new fields are considered.
using Reads = std::map<std::string, std::string>;

/// For the threshold of a predicate, which depends neither on itself nor on `missing`.
Reads reads(const Model& model, Index predicate);
/// For the shift of a monitor, which depends on the formula and on the same formula over truths.
Reads reads(const Model& model, const Monitor& monitor);
Reads reads(const Model& model, const Fitted& fitted);

/// Returns "WHAT was: THEN; it is: NOW".
std::string changed(std::string_view what, std::string_view then, std::string_view now);

/// Returns the differences as sentences: "predicate a was: x <= 0.5; it is: x <= 1".
std::vector<std::string> differences(const Reads& then, const Reads& now);

struct Provenance {
    std::string predicate;  ///< canonical text without the threshold
    /// canonical text of the truth with its predicates and lets written out; empty if there is none
    std::string truth;
    /// Content hashes: targets by name; weights of mahalanobis distances by the distance's text; by
    /// input name, the declaration of inputs whose samples it changes (float16 or int8, scale,
    /// range, hold and staleness); and fingerprints of encoders.
    std::map<std::string, std::string> targets;
    /// Such hashes for the truth formula.
    std::map<std::string, std::string> truth_targets;
    Reads reads;
};

/// The number of episodes in which an array gave the labels of a predicate.
struct Labelling {
    std::size_t episodes = 0;
    std::map<Index, std::size_t> from_arrays;
};

/// Returns `truth` as written to an entry: the text of the truth in the spec; "array" without one;
/// "array in place of TEXT" or, for some of the episodes, "array or TEXT".
std::string labels(const std::string& truth, Index predicate, const Labelling& labelling);
/// Returns the truth in the spec from such a text; empty if there was none.
std::string stated(std::string labels);

Provenance provenance(const Model& model, Index predicate);

/// For a calibrated monitor: `predicate` is its formula with all predicates and thresholds written
/// out, `truth` lists the labels of each, `targets` are those of both.
Provenance provenance(const Model& model, const Monitor& monitor, const Labelling& labelling = {});

/// The texts and hashes that a fitted element depends on besides the demonstrations.
struct FittedProvenance {
    std::string of;     ///< the point and the hashes of its maps, "Q(z), Q = 0123456789abcdef"
    std::string truth;  ///< `where`, the labels of its predicates and what they measure; or "true"
    Reads reads;
};
FittedProvenance provenance(const Model& model, const Fitted& fitted,
                            const Labelling& labelling = {});

/// Returns the predicates in a formula, ascending.
std::vector<Index> predicates_of(const Model& model, Index formula);
/// Returns those in the monitor's formula or in that of its truth.
std::vector<Index> predicates_of(const Model& model, const Monitor& monitor);
/// Returns the boolean inputs in a formula, ascending.
std::vector<Index> flags_of(const Model& model, Index formula);

}  // namespace etlc::check
