// Text from outside - names of files, words of the spec, of data and of thresholds - made fit for
// what it is printed to. Takes: any bytes. Gives: text that stays one piece where it stands, and
// shows a reader what it is. Keeps true: what is printed of an outside text goes through one of
// these; none of them changes plain words.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace etlc::source {

/// For terminals and messages: what a reader would not see as it is (is_hidden) as \u{202E}, or as
/// \x1b where it is one byte, as bytes that are not UTF-8. One line.
std::string visible(std::string_view text);

/// The same for reports of many lines, which keep their line ends.
std::string visible_lines(std::string_view text);

/// For a line of generated code that ends in an outside text, as a comment: visible, and the next
/// line is not part of it.
std::string code_line(std::string_view text);

/// For JSON: in double quotes; bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

/// For DOT: in double quotes.
std::string dot_string(std::string_view text);

/// For a dependency file: a path as make and ninja both read it; none where they cannot, since of
/// such names each has others.
enum class InRule { target, prerequisite };
std::optional<std::string> depfile_path(std::string_view path, InRule place);

}  // namespace etlc::source
