// The language server, `etlc lsp` (docs/editors.md).
#pragma once

namespace etlc::lsp {

/// Serves a client until its input ends. Returns the exit status of the protocol: 0 after
/// `shutdown`, else 1. Bad messages are answered or ignored, as the protocol says.
int serve(int in, int out);

}  // namespace etlc::lsp
