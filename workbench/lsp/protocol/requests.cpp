// Who answers which request.
#include "lsp/answers/actions.hpp"
#include "lsp/answers/completion.hpp"
#include "lsp/answers/hover.hpp"
#include "lsp/answers/navigation.hpp"
#include "lsp/format/format.hpp"
#include "lsp/protocol/session.hpp"

namespace etlc::lsp {

namespace {

std::uint32_t offset_of(Document& document, const Json& params) {
    return document.analysis().lines.offset(position_of(member(params, "position")));
}

}  // namespace

Json Session::hover(const Json& params) {
    Document& document = document_of(params);
    return lsp::hover(document, offset_of(document, params), client_.hover_in_markdown);
}

Json Session::definition(const Json& params) {
    Document& document = document_of(params);
    return lsp::definition(document.analysis(), offset_of(document, params), document.uri());
}

Json Session::references(const Json& params) {
    Document& document = document_of(params);
    const Json* const with_declaration = find_path(params, "context/includeDeclaration");
    return lsp::references(document.analysis(), offset_of(document, params), document.uri(),
                           with_declaration == nullptr || *with_declaration == true);
}

Json Session::highlights(const Json& params) {
    Document& document = document_of(params);
    return lsp::highlights(document.analysis(), offset_of(document, params));
}

Json Session::prepare_rename(const Json& params) {
    Document& document = document_of(params);
    return lsp::prepare_rename(document.analysis(), offset_of(document, params));
}

Json Session::rename(const Json& params) {
    Document& document = document_of(params);
    return lsp::rename(document.analysis(), offset_of(document, params), text_of(params, "newName"),
                       document.uri());
}

Json Session::completion(const Json& params) {
    Document& document = document_of(params);
    return lsp::completion(document.analysis(), offset_of(document, params));
}

Json Session::symbols(const Json& params) {
    Document& document = document_of(params);
    return lsp::symbols(document.analysis(), document.uri(), client_.hierarchical_symbols);
}

Json Session::code_actions(const Json& params) {
    Document& document = document_of(params);
    const Analysis& analysis = document.analysis();
    const source::Span range = analysis.lines.span(range_of(member(params, "range")));
    return lsp::code_actions(analysis, range, document.uri());
}

/// The lines that change, as one edit, so that marks in other lines stay.
Json Session::formatting(const Json& params) {
    Document& document = document_of(params);
    const Analysis& analysis = document.analysis();
    const auto after = formatted(analysis.file);
    if (!after) return nullptr;
    const std::string_view before = analysis.file.text();
    if (*after == before) return Json::array();
    std::size_t same = 0;
    while (same < before.size() && same < after->size() && before[same] == (*after)[same]) ++same;
    const std::size_t line = before.rfind('\n', same == 0 ? 0 : same - 1);
    const std::size_t begin = same == 0 || line == std::string_view::npos ? 0 : line + 1;
    std::size_t end = 0;  // bytes from the end
    while (end < before.size() - begin && end < after->size() - begin &&
           before[before.size() - end - 1] == (*after)[after->size() - end - 1])
        ++end;
    // It ends behind a line end, of which no half is left out.
    const std::size_t tail = before.find('\n', before.size() - end);
    end = tail == std::string_view::npos ? 0 : before.size() - tail - 1;
    const source::Span span{static_cast<std::uint32_t>(begin),
                            static_cast<std::uint32_t>(before.size() - end)};
    return Json::array({{{"range", json_of(analysis.lines.range(span))},
                         {"newText", after->substr(begin, after->size() - end - begin)}}});
}

}  // namespace etlc::lsp
