// The language server: `etlc lsp`.
// Takes: the descriptors of a client's messages and of the answers. Gives: the exit status of the
// protocol: 0 after `shutdown`, else 1. Keeps true: it ends at the end of its input; bad messages
// are answered or passed over, as the protocol says (docs/editors.md).
#pragma once

namespace etlc::lsp {

int serve(int in, int out);

}  // namespace etlc::lsp
