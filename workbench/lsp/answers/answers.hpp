// The answers of the language server, a function for each request of the protocol.
// Takes: an open document and the parameters of the request. Gives: the result, null where there is
// none. Throws Refusal where a request cannot be answered. Keeps true: figures are those of the
// generated header; the same place of a text gives the same answer.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lsp/spec/analysis.hpp"
#include "lsp/text/json.hpp"

namespace etlc::lsp {

struct Client {
    bool related_places = false;  ///< of a finding
    bool hover_in_markdown = false;
    bool hierarchical_symbols = false;
};

/// A request about a document.
struct Question {
    Document& document;
    const Json& params;
    const Client& client;

    const Analysis& analysis() const { return document.analysis(); }
    const std::string& uri() const { return document.uri(); }
    /// The place that `position` names.
    std::uint32_t offset() const {
        return analysis().lines.offset(position_of(member(params, "position")));
    }
};

/// Answers with the declaration of a name and what is known of it, or with the meaning of a word of
/// the language. For the budget of a monitor it plans the model. What has an error is shown as it
/// is written.
Json hover(const Question& question);
/// Answers with names of the kinds that fit, words that the grammar takes there, and durations that
/// are whole numbers of steps.
Json completion(const Question& question);

/// Answers with the declaration of a name, or with a file that the spec loads.
Json definition(const Question& question);
Json references(const Question& question);
Json highlights(const Question& question);
/// Answers with the outline: DocumentSymbols where the client shows them, else SymbolInformation.
Json symbols(const Question& question);

/// Answers with the range that would be renamed.
Json prepare_rename(const Question& question);
/// Answers with a WorkspaceEdit. Refuses a rename that would change what anything else means.
Json rename(const Question& question);
/// Answers with an edit for each finding in a range that says what was probably meant; a name is
/// changed everywhere.
Json code_actions(const Question& question);

/// The findings of `etlc SPEC --check` and of planning in the order of their places, each once. One
/// about another file is shown where the spec names that file.
Json diagnostics_of(const Analysis& analysis, const Planned* planned, const std::string& uri,
                    const Client& client);

/// Describes a name by what the model knows of it, in sentences, the most important first.
/// `planned`: null where monitors have not been planned.
std::vector<std::string> facts_of(const Analysis& analysis, const std::string& name,
                                  const Planned* planned);

// The words of the language and their meanings, one line each.

struct WordInfo {
    enum class Kind : std::uint8_t {
        keyword,
        type,
        unit,
        operation,
        function,  ///< also an aggregation or a distance
        argument,  ///< of calibrated(...), fitted(...) or an encoder; no word of the grammar
    };
    std::string_view word;
    Kind kind;
    std::string_view form;  ///< syntax: "F[a, b] f"
    std::string_view meaning;
};

const std::vector<WordInfo>& all_words();
/// Finds a word of the language; null for any other word.
const WordInfo* find_word(std::string_view word);

}  // namespace etlc::lsp
