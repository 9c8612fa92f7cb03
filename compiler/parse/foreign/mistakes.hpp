// Tokens that are mistakes: characters, numbers and operators that the language does not have.
#pragma once

#include <optional>

#include "parse/stream/tokens.hpp"

namespace etlc::parse {

/// What to say of a token for which is_mistake() holds, and of what it stands behind (null: of
/// nothing); nothing where its bytes are not UTF-8, which has been said of the file as a whole.
std::optional<diag::Diagnostic> explain_mistake(const Token& token, const Token* previous,
                                                const source::File& file);

}  // namespace etlc::parse
