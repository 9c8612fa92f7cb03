// A file's bytes as ANTLR's character stream.
// Takes: a text that outlives it. Gives: one character a byte, so that ANTLR's indices are our
// offsets. Keeps true: every byte above ASCII reads as DEL: outside strings and comments none of
// them can stand, inside any can, and ANTLR caches its transitions for ASCII alone.
#pragma once

#include <string>
#include <string_view>

#include "antlr4-runtime.h"

namespace etlc::parse {

class ByteStream final : public antlr4::CharStream {
public:
    explicit ByteStream(std::string_view text) : text_(text) {}

    void consume() override;
    std::size_t LA(ssize_t i) override;
    ssize_t mark() override { return 0; }
    void release(ssize_t /*marker*/) override {}
    std::size_t index() override { return at_; }
    void seek(std::size_t index) override;
    std::size_t size() override { return text_.size(); }
    std::string getSourceName() const override { return {}; }
    std::string getText(const antlr4::misc::Interval& interval) override;
    std::string toString() const override { return std::string(text_); }

private:
    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace etlc::parse
