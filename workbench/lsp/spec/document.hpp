// A text that is open in the client.
// Takes: its edits. Gives: its present text, and what the compiler finds out about it, when asked.
// Keeps true: each state of the text is analysed once at most, and not before somebody asks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "lsp/spec/analysis.hpp"
#include "lsp/text/position.hpp"

namespace etlc::lsp {

class Document {
public:
    Document(std::string uri, std::string text, std::int64_t version, Encoding encoding);

    const std::string& uri() const { return uri_; }
    const std::string& text() const { return text_; }
    std::int64_t version() const { return version_; }

    void replace(std::string text);
    /// An edit that ends before it begins is one of the text in between.
    void replace(Range range, std::string_view text);
    void set_version(std::int64_t version) { version_ = version; }
    /// Files that it loads may have changed.
    void forget();

    const Analysis& analysis();
    /// Null: the model is not complete, or it has not been planned.
    const Planned* planned() const { return planned_ ? &*planned_ : nullptr; }
    void plan();

    /// The client has not been told of this state, or not of all that planning finds.
    bool is_news = true;
    bool is_planned = false;

private:
    std::string uri_;
    std::string text_;
    std::int64_t version_;
    Encoding encoding_;
    check::KnownMatrices known_;
    std::unique_ptr<Analysis> analysis_;
    std::optional<Planned> planned_;
};

}  // namespace etlc::lsp
