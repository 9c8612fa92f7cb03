// The text of everything that a calibrated threshold or a fitted element depends on besides the
// demonstrations. `etlc calibrate` and `etlc fit` write it, and check/ compares it: two specs with
// equal texts need the same threshold from the same demonstrations.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

/// A canonical text for each thing that scores or frames are computed from, by kind and name
/// ("input z"). Models with equal texts compute the same from the same episodes. The function
/// decomposes every struct of the model, so it does not compile until new fields are considered.
/// Values and weights appear as hashes: "1 x 2, values #b08b72ea4df23cb1".
using Reads = std::map<std::string, std::string>;

/// The number of episodes in which an array or a table gave the labels of a predicate. Its truth is
/// then "an array or table", "an array or table in place of TEXT" or, for some of the episodes, "an
/// array or table, or TEXT".
struct Labelling {
    std::size_t episodes = 0;
    std::map<Index, std::size_t> from_arrays;
};

/// For the threshold of a predicate, which depends neither on itself nor on `missing`.
Reads reads(const Model& model, Index predicate, const Labelling& labelling = {});
/// For the shift of a monitor, which depends on the formula and on the same formula over truths.
Reads reads(const Model& model, const Monitor& monitor, const Labelling& labelling = {});
Reads reads(const Model& model, const Fitted& fitted, const Labelling& labelling = {});

/// Whether arrays or tables gave labels in place of a truth.
bool replaces_truths(const Reads& reads);

/// Returns "WHAT was: THEN; it is: NOW".
std::string changed(std::string_view what, std::string_view then, std::string_view now);

/// Returns the differences as sentences: "predicate a was: x <= 0.5; it is: x <= 1". Arrays in
/// place of a truth make none while the truth is the same.
std::vector<std::string> differences(const Reads& then, const Reads& now);

/// Returns the predicates in a formula, ascending.
std::vector<Index> predicates_of(const Model& model, Index formula);
/// Returns those in the monitor's formula or in that of its truth.
std::vector<Index> predicates_of(const Model& model, const Monitor& monitor);
/// Returns the boolean inputs in a formula, ascending.
std::vector<Index> flags_of(const Model& model, Index formula);

}  // namespace etlc::check
