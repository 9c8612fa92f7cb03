// What may stand at a place.
// Takes: a place of a document. Gives: names of the kinds that fit there, words of the language
// that the grammar takes there, and durations that are whole numbers of steps. Keeps true: nothing
// is offered that the grammar would refuse; the same place gives the same items.
#pragma once

#include <cstdint>

#include "lsp/spec/analysis.hpp"
#include "lsp/text/json.hpp"

namespace etlc::lsp {

Json completion(const Analysis& analysis, std::uint32_t offset);

}  // namespace etlc::lsp
