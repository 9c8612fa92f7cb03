// Text of a program, line by line, indented by blocks.
// Takes: lines. Gives: the text. Keeps true: two spaces a level, no trailing blanks, lines end in
// \n; text from outside ends where its line does, whatever it is.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "source/escape.hpp"

namespace etlc::emit {

class Printer {
public:
    void line(std::string_view text = {}) {
        if (!text.empty()) text_.append(2 * depth_, ' ').append(source::code_line(text));
        text_.push_back('\n');
    }
    template <class... Args>
    void line(fmt::format_string<Args...> format, Args&&... args) requires(sizeof...(Args) > 0) {
        line(std::string_view(fmt::format(format, std::forward<Args>(args)...)));
    }
    /// A blank line, unless there is one or a block begins here.
    void gap() {
        const bool open = text_.size() > 1 && text_[text_.size() - 2] == '{';
        const bool blank = text_.size() > 1 && text_[text_.size() - 2] == '\n';
        if (!open && !blank) text_.push_back('\n');
    }
    /// A line at the outer level, for `public:` one space in.
    void label(std::string_view text) {
        text_.append(2 * depth_ - 1, ' ').append(text).push_back('\n');
    }
    void open(std::string_view text) {
        line(text);
        ++depth_;
    }
    void close(std::string_view text = "}") {
        --depth_;
        line(text);
    }
    void indent() { ++depth_; }
    void dedent() { --depth_; }
    std::size_t column() const { return 2 * depth_; }

    std::string take() { return std::move(text_); }

private:
    std::string text_;
    std::size_t depth_ = 0;
};

/// Longest line of generated code.
inline constexpr std::size_t kLineWidth = 100;

}  // namespace etlc::emit
