// What mends a finding.
// Takes: findings that say what was probably meant. Gives: code actions, each one edit. Keeps true:
// a name that is changed where it is declared is changed everywhere.
#pragma once

#include "lsp/spec/analysis.hpp"
#include "lsp/text/json.hpp"

namespace etlc::lsp {

/// Of the findings that `range` touches.
Json code_actions(const Analysis& analysis, source::Span range, const std::string& uri);

}  // namespace etlc::lsp
