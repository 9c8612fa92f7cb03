// Text from outside - names of files, words of the spec, of data and of thresholds - made fit for
// what it is printed to. Takes: any bytes. Gives: text that cannot break out of its place, and
// shows a reader what it is. Keeps true: every outside text is printed through one of these, and
// none of them changes plain words.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace etlc::source {

/// For terminals and messages, in one line: hidden characters (is_hidden) become \u{202E}, single
/// bytes such as those that are not UTF-8 \x1b.
std::string visible(std::string_view text);

/// The same for reports of many lines, which keep their line ends.
std::string visible_lines(std::string_view text);

/// For a line of generated code that ends in an outside text, as a comment: visible, and the next
/// line is not part of it.
std::string code_line(std::string_view text);

/// For JSON: in double quotes; bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

/// A cell of a CSV row: in quotes where it has to be.
std::string csv_cell(std::string_view text);

/// For DOT: in double quotes.
std::string dot_string(std::string_view text);

/// For a dependency file: a path as make and ninja both read it; nothing where one of them cannot
/// (each has names that the other takes).
enum class InRule { target, prerequisite };
std::optional<std::string> depfile_path(std::string_view path, InRule place);

}  // namespace etlc::source
