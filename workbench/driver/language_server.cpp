#include "driver/language_server.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>

#include "driver/options/command_line.hpp"
#include "lsp/lsp.hpp"

namespace etlc::driver {

int language_server_command(int argc, char** argv) {
    CLI::App app(
        "The language server, for editors: it speaks the Language Server Protocol on standard "
        "input and output.\ndocs/editors.md says how editors start it.",
        "etlc lsp");
    bool on_standard_streams = false;
    app.add_flag("--stdio", on_standard_streams,
                 "that is how it speaks anyway; some clients say it");
    if (const auto status = parse_arguments(app, argc, argv)) return *status;
    return lsp::serve(STDIN_FILENO, STDOUT_FILENO);
}

}  // namespace etlc::driver
