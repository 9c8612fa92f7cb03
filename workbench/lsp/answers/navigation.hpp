// Where a name stands: definition, references, highlights, rename, and the outline of a spec.
// Takes: a place of a document. Gives: places and edits. Keeps true: a rename that would change
// what anything else means is refused, with the reason.
#pragma once

#include <cstdint>
#include <string>

#include "lsp/spec/analysis.hpp"
#include "lsp/text/json.hpp"

namespace etlc::lsp {

/// Of a name its declaration, of a file that the spec loads the file; null: neither stands there.
Json definition(const Analysis& analysis, std::uint32_t offset, const std::string& uri);
Json references(const Analysis& analysis, std::uint32_t offset, const std::string& uri,
                bool with_declaration);
Json highlights(const Analysis& analysis, std::uint32_t offset);
/// `hierarchical`: as DocumentSymbol, else as SymbolInformation.
Json symbols(const Analysis& analysis, const std::string& uri, bool hierarchical);

/// What would be renamed. Throws Refusal where no name stands there.
Json prepare_rename(const Analysis& analysis, std::uint32_t offset);
/// A WorkspaceEdit. Throws Refusal with the reason where it cannot be.
Json rename(const Analysis& analysis, std::uint32_t offset, const std::string& new_name,
            const std::string& uri);

/// The edits that give what this is one of another name, everywhere.
Json edits_of_name(const Analysis& analysis, const Occurrence& of, const std::string& new_name);

}  // namespace etlc::lsp
