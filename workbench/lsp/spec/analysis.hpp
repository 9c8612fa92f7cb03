// What the compiler finds out about one state of a text.
// Takes: the text, and the path that it has or would have. Gives: its findings, its names and its
// model, as `etlc SPEC --check` sees them: what is not there yet is a note. Keeps true: it is the
// compiler's own front end; no file is written.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "check/check.hpp"
#include "diag/diag.hpp"
#include "lsp/spec/names.hpp"
#include "lsp/text/position.hpp"
#include "pipeline/compile.hpp"
#include "source/source.hpp"

namespace etlc::lsp {

struct Analysis {
    /// `known`: what the files of the spec gave before.
    Analysis(std::string path, std::string text, Encoding encoding, check::KnownMatrices& known);
    Analysis(const Analysis&) = delete;  // `lines` look at `file`
    Analysis& operator=(const Analysis&) = delete;

    source::File file;
    Lines lines;
    diag::Sink sink;
    bool has_syntax_errors = false;
    Names names;
    check::Inspected checked;
};

/// What is found only where monitors are planned, which takes longer.
struct Planned {
    diag::Sink sink;
    std::optional<pipeline::Compiled> compiled;
};

/// Nothing where the model is not complete.
std::optional<Planned> plan(const Analysis& analysis);

}  // namespace etlc::lsp
