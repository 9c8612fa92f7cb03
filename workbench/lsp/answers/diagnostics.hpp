// The compiler's findings as the protocol shows them.
// Takes: an analysis, and what planning found. Gives: the diagnostics of one document, in the order
// of their places. Keeps true: each finding of `etlc SPEC --check` is there once, with its code and
// its notes; one about another file stands where the spec names that file.
#pragma once

#include "lsp/spec/analysis.hpp"
#include "lsp/text/json.hpp"

namespace etlc::lsp {

/// `with_related`: the client shows places that a finding mentions.
Json diagnostics_of(const Analysis& analysis, const Planned* planned, const std::string& uri,
                    bool with_related);

/// Where a finding is shown.
source::Span place_of(const diag::Diagnostic& found, const Analysis& analysis);

}  // namespace etlc::lsp
