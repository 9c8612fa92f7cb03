#include "lsp/spec/analysis.hpp"

#include "parse/parse.hpp"

namespace etlc::lsp {

Analysis::Analysis(std::string path, std::string text, Encoding encoding,
                   check::KnownMatrices& known)
    : file(std::move(path), std::move(text)), lines(file.text(), encoding) {
    ast::Spec spec = parse::parse(file, sink);
    has_syntax_errors = sink.has_errors();
    names = names_of(spec, file);
    if (has_syntax_errors) add_uncertain(names, file);
    check::Options options;
    options.allow_missing = true;
    checked = check::inspect(std::move(spec), file, options, known, sink);
}

std::optional<Planned> plan(const Analysis& analysis) {
    if (!analysis.checked.complete) return std::nullopt;
    Planned result;
    check::Model model = analysis.checked.model;
    result.compiled = pipeline::compile(std::move(model), {}, result.sink);
    return result;
}

}  // namespace etlc::lsp
