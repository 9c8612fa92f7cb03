// A model whose numbers may change while its monitors run: --retargetable.
// Takes: the model, checked with the numbers that the spec has now. Gives: the model as it holds
// with any. Keeps true: what cannot change between steps is refused; predicates may have any
// robustness, so bounds rest on no number; every predicate has a name, so nothing is named after
// one.
#pragma once

#include "check/context/context.hpp"

namespace etlc::check {

void make_retargetable(Context& c);

}  // namespace etlc::check
