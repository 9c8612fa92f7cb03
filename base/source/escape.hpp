// Escapes text from outside (file names, words of the spec, of data and of thresholds) for what it
// is printed to, so that it cannot break out of its place and a reader sees what it is. All such
// text is printed through these functions; plain words stay as they are.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace etlc::source {

/// Escapes for terminals and messages, in one line: hidden characters (is_hidden) become \u{202E},
/// control bytes and bytes that are not UTF-8 become \x1b.
std::string visible(std::string_view text);

/// Escapes a report of many lines in the same way; line ends stay.
std::string visible_lines(std::string_view text);

/// Escapes text at the end of a comment in generated code, so that the next line does not belong to
/// it.
std::string code_line(std::string_view text);

/// Returns the text as a JSON string in quotes; bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

/// Returns the text as a cell of a CSV row, in quotes where necessary.
std::string csv_cell(std::string_view text);

/// Returns the text as a DOT string in quotes.
std::string dot_string(std::string_view text);

/// Escapes a path for a dependency file that make and ninja both read; nothing where one of them
/// cannot (each accepts names that the other does not).
enum class InRule { target, prerequisite };
std::optional<std::string> depfile_path(std::string_view path, InRule place);

}  // namespace etlc::source
