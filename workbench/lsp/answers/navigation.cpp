#include "lsp/answers/answers.hpp"

#include <filesystem>

#include "lsp/text/uri.hpp"

namespace etlc::lsp {

namespace {

Json location(const std::string& uri, Range range) {
    return {{"uri", uri}, {"range", range}};
}

/// Returns the protocol's number of a kind of symbol.
int symbol_kind(const Declared& declared) {
    constexpr int kNamespace = 3;
    constexpr int kField = 8;
    constexpr int kFunction = 12;
    constexpr int kVariable = 13;
    constexpr int kConstant = 14;
    constexpr int kBoolean = 17;
    constexpr int kArray = 18;
    constexpr int kEvent = 24;
    if (!declared.kind) return kNamespace;
    switch (*declared.kind) {
        case check::NameKind::constant: return kConstant;
        case check::NameKind::encoder:
        case check::NameKind::projection: return kFunction;
        case check::NameKind::input: return kField;
        case check::NameKind::target: return kArray;
        case check::NameKind::predicate: return kBoolean;
        case check::NameKind::monitor: return kEvent;
        case check::NameKind::let:
        case check::NameKind::unreadable: break;
    }
    return kVariable;
}

std::string detail_of(const Declared& declared) {
    return declared.kind ? std::string(check::word(*declared.kind)) : "spec";
}

}  // namespace

Json definition(const Question& question) {
    const Analysis& analysis = question.analysis();
    const std::uint32_t offset = question.offset();
    if (const Occurrence* const at = occurrence_at(analysis.names(), offset)) {
        const Declared* const declared = declaration_of(analysis.names(), *at);
        if (declared == nullptr) return nullptr;
        return location(question.uri(), analysis.lines.range(declared->name_span));
    }
    for (const NamedFile& named : analysis.names().files) {
        if (offset < named.span.begin || offset > named.span.end) continue;
        const std::filesystem::path path =
            std::filesystem::path(analysis.file.path()).parent_path() / named.path;
        std::error_code error;
        if (!std::filesystem::is_regular_file(path, error)) return nullptr;
        return location(uri_of_path(path.string()), {});
    }
    return nullptr;
}

Json references(const Question& question) {
    const Analysis& analysis = question.analysis();
    const Json* const asked = find_path(question.params, "context/includeDeclaration");
    const bool with_declaration = asked == nullptr || *asked == true;
    const Occurrence* const at = occurrence_at(analysis.names(), question.offset());
    if (at == nullptr) return nullptr;
    Json all = Json::array();
    for (const Occurrence& occurrence : analysis.names().occurrences)
        if (occurrence.means_the_same(*at) && (with_declaration || !occurrence.declares))
            all.push_back(location(question.uri(), analysis.lines.range(occurrence.span)));
    return all;
}

Json highlights(const Question& question) {
    const Analysis& analysis = question.analysis();
    const Occurrence* const at = occurrence_at(analysis.names(), question.offset());
    if (at == nullptr) return nullptr;
    constexpr int kRead = 2;
    constexpr int kWrite = 3;
    Json all = Json::array();
    for (const Occurrence& occurrence : analysis.names().occurrences)
        if (occurrence.means_the_same(*at))
            all.push_back({{"range", analysis.lines.range(occurrence.span)},
                           {"kind", occurrence.declares ? kWrite : kRead}});
    return all;
}

Json symbols(const Question& question) {
    const Analysis& analysis = question.analysis();
    Json all = Json::array();
    for (const Declared& declared : analysis.names().declared) {
        Json symbol{{"name", declared.name}, {"kind", symbol_kind(declared)}};
        const Range whole = analysis.lines.range(declared.span);
        if (question.client.hierarchical_symbols) {
            symbol["detail"] = detail_of(declared);
            symbol["range"] = whole;
            symbol["selectionRange"] = analysis.lines.range(declared.name_span);
        } else {
            symbol["location"] = location(question.uri(), whole);
        }
        all.push_back(std::move(symbol));
    }
    return all;
}

}  // namespace etlc::lsp
