#include "lsp/spec/document.hpp"

#include <utility>

#include "lsp/text/uri.hpp"

namespace etlc::lsp {

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
    is_planned = false;
    is_news = true;
}

const Analysis& Document::analysis() {
    if (!analysis_)
        analysis_ = std::make_unique<Analysis>(path_of_uri(uri_), text_, encoding_, known_);
    return *analysis_;
}

void Document::plan() {
    if (is_planned) return;
    planned_ = lsp::plan(analysis());
    is_planned = true;
    is_news = is_news || (planned_ && !planned_->sink.sorted().empty());
}

}  // namespace etlc::lsp
