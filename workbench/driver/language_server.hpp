// `etlc lsp`: the language server, for editors.
#pragma once

namespace etlc::driver {

/// The exit status of the protocol: 0 after `shutdown`, else 1; or what a wrong call gives.
int language_server_command(int argc, char** argv);

}  // namespace etlc::driver
