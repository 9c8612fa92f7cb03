// A source line and its carets, as a terminal shows them.
// Takes: a file and a span. Gives: two lines of text. Keeps true: the carets stand under the span
// whatever the line holds (tabs, wide and combining characters, bytes that are not UTF-8), and both
// lines have a bounded width.
#pragma once

#include <string>
#include <string_view>

#include "source/source.hpp"

namespace etlc::diag {

struct SourceView {
    /// The line, or a part of it around the span between "..." where it is very long.
    std::string text;
    std::string carets;  ///< blanks (tabs where the line has them), then ^~~~
};

SourceView view(const source::File& file, source::Span span);

}  // namespace etlc::diag
