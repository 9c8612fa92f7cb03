// Prints diagnostics as text with carets (`spec.etl:12:24: error: ... [E0204]`, the source line, a
// caret under the span, then notes) or as JSON. The same findings give the same bytes.
#pragma once

#include <string>

#include "diag/diag.hpp"

namespace etlc::diag {

enum class Colour { none, ansi };

std::string render_text(const source::File& spec, const Sink& sink, Colour colour = Colour::none);
/// {"diagnostics": [{"code", "severity", "message", "file", "line", "column", "end_line",
/// "end_column", "notes"}]}
std::string render_json(const source::File& spec, const Sink& sink);

}  // namespace etlc::diag
