// What the scripts of the shells share, and the calls that print them.
#include <fmt/format.h>

#include <algorithm>

#include "driver/manual/manual.hpp"
#include "driver/options/mistakes.hpp"
#include "driver/process/output_file.hpp"
#include "driver/process/process.hpp"
#include "library/version.hpp"

namespace etlc::driver {

Paths paths_of(const OptionHelp& option) {
    const std::string& value = option.value;
    if (value == "SPEC.etl") return Paths::specs;
    if (value == "FOLDER") return Paths::folders;
    for (const char* const path : {"FILE", "PART...", "PATH"})
        if (value.rfind(path, 0) == 0) return Paths::files;
    return Paths::none;
}

std::string word_of(const CommandHelp& command) {
    const std::size_t blank = command.name.find(' ');
    return blank == std::string::npos ? "" : command.name.substr(blank + 1);
}

std::string first_sentence(const std::string& text) {
    std::string line = text;
    std::replace(line.begin(), line.end(), '\n', ' ');
    const std::size_t end = std::min(line.find(". "), line.find(": "));
    if (end != std::string::npos) line.resize(end);
    if (line.ends_with('.')) line.pop_back();
    return line;
}

namespace {

int print_text(const std::string& text) {
    diag::Sink sink;
    print(text, sink);
    return sink.refused() ? kFailed : kDone;
}

}  // namespace

int completion_command(const std::string& shell) {
    const std::string mistake = mistake_in_word(shell, {std::begin(kShells), std::end(kShells)});
    if (!mistake.empty()) {
        print_error(fmt::format("etlc: --completion: {}\n", mistake));
        return kWrongCall;
    }
    const std::vector<CommandHelp> commands = all_help();
    return print_text(shell == "bash"  ? completion_of_bash(commands)
                      : shell == "zsh" ? completion_of_zsh(commands)
                                       : completion_of_fish(commands));
}

int manual_command() {
    return print_text(manual_page(all_help(), library::kVersion));
}

}  // namespace etlc::driver
