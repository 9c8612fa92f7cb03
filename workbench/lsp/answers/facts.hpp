// What the model knows of a name, in sentences.
// Takes: an analysis, a name, and the plan where there is one. Gives: sentences, the most important
// first; none of what is broken. Keeps true: figures are those of the generated header.
#pragma once

#include <string>
#include <vector>

#include "lsp/spec/analysis.hpp"

namespace etlc::lsp {

/// `planned`: null where monitors have not been planned.
std::vector<std::string> facts_of(const Analysis& analysis, const std::string& name,
                                  const Planned* planned);

}  // namespace etlc::lsp
