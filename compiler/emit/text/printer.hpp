// Collects the lines of a program, indented by two spaces per block. Lines have no trailing blanks
// and end in \n; text from outside cannot end its line.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "source/text.hpp"

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
    /// Adds a blank line, unless the last line is blank or opens a block.
    void gap() {
        const bool open = text_.size() > 1 && text_[text_.size() - 2] == '{';
        const bool blank = text_.size() > 1 && text_[text_.size() - 2] == '\n';
        if (!open && !blank) text_.push_back('\n');
    }
    /// Adds a label such as `public:`, one space inside the outer level.
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
    std::size_t column() const { return 2 * depth_; }

    std::string take() { return std::move(text_); }

private:
    std::string text_;
    std::size_t depth_ = 0;
};

/// Width of generated code, in columns.
inline constexpr std::size_t kLineWidth = 100;

}  // namespace etlc::emit
