// All that a guarantee was made from, as text.
// Takes: a calibrated predicate, a calibrated monitor or a fitted thing of the model. Gives: for
// each thing that its scores or frames are computed from, by kind and name ("input z"), a canonical
// text. Keeps true: two models with equal texts make the same of the same episodes. Every struct of
// the model is taken apart into all its fields, so a new field does not compile before somebody has
// said whether it counts.
#pragma once

#include <map>
#include <string>

#include "check/model/model.hpp"

namespace etlc::check {

using Reads = std::map<std::string, std::string>;

/// Of its threshold: the threshold itself and `missing` are not read by it.
Reads reads(const Model& model, Index predicate);
/// Of its shift: the monitor without it, beside the same formula over the truths.
Reads reads(const Model& model, const Monitor& monitor);
Reads reads(const Model& model, const Fitted& fitted);

/// What differs between two of them, a sentence each: "predicate a was: x <= 0.5; it is: x <= 1".
std::vector<std::string> differences(const Reads& then, const Reads& now);

}  // namespace etlc::check
