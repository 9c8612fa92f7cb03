#include "lsp/spec/analysis.hpp"

#include <utility>

#include "lsp/text/uri.hpp"
#include "parse/parse.hpp"
#include "recordings/open.hpp"

namespace etlc::lsp {

Analysis::Analysis(std::string path, std::string text, Encoding encoding,
                   check::KnownMatrices& known)
    : file(std::move(path), std::move(text)), lines(file.text(), encoding) {
    spec = parse::parse(file, sink);
    has_syntax_errors = sink.has_errors();
    check::Options options;
    options.open_trace = recordings::open_trace;
    options.allow_missing = true;
    checked =
        std::make_unique<const check::Inspected>(check::inspect(spec, file, options, known, sink));
}

const Names& Analysis::names() const {
    if (!names_) {
        names_ = names_of(spec, file);
        if (has_syntax_errors) add_uncertain(*names_, parse::words_of(file), file);
    }
    return *names_;
}

Document::Document(std::string uri, std::string text, std::int64_t version, Encoding encoding)
    : uri_(std::move(uri)), text_(std::move(text)), version_(version), encoding_(encoding) {}

void Document::replace(std::string text) {
    text_ = std::move(text);
    forget();
}

void Document::replace(Range range, std::string_view text) {
    if (range.end < range.start) std::swap(range.start, range.end);
    const source::Span span = Lines(text_, encoding_).span(range);
    text_.replace(span.begin, span.end - span.begin, text);
    forget();
}

void Document::forget() {
    planned_.reset();
    analysis_.reset();
    is_news = true;
}

const Analysis& Document::analysis() {
    if (!analysis_)
        analysis_ = std::make_unique<Analysis>(path_of_uri(uri_), text_, encoding_, known_);
    return *analysis_;
}

void Document::plan() {
    const check::Model& model = analysis().checked->model;
    planned_ = std::make_unique<Planned>();  // where it fails there is no plan, and no second try
    planned_->compiled = compile(model, {}, planned_->sink);
    is_news = is_news || !planned_->sink.sorted().empty();
}

}  // namespace etlc::lsp
