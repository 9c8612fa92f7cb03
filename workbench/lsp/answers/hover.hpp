// What stands at a place.
// Takes: a place of a document. Gives: for a name its declaration and what is known of it (type,
// dimension, threshold with origin and guarantee, budget of a monitor), for a word of the language
// its meaning. Keeps true: what has an error is shown as it is written, without what follows of it.
#pragma once

#include <cstdint>

#include "lsp/spec/document.hpp"
#include "lsp/text/json.hpp"

namespace etlc::lsp {

/// null: nothing is known of the place. The budget of a monitor is planned for.
Json hover(Document& document, std::uint32_t offset, bool with_markdown);

}  // namespace etlc::lsp
