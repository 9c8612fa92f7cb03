#include "driver/codes/explain_code.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data/text/text.hpp"
#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"

namespace etlc::driver {

namespace {

/// Returns the diagnostic of this code in the output, with its source and notes, or "".
std::string message_of(std::string_view printed, std::string_view code) {
    const std::string tag = fmt::format("[{}]", code);
    std::string message;
    for (const std::string_view line : split_lines(printed)) {
        const bool is_head = !line.starts_with(' ');
        const bool is_note = line.find(": note: ") != std::string_view::npos;
        if (is_head && !message.empty() && !is_note) break;
        const bool is_meant = line.find(tag) != std::string_view::npos;
        if (!message.empty() || is_meant) message += line;
    }
    return message;
}

}  // namespace

bool is_code(std::string_view text) {
    constexpr std::size_t kLength = 5;
    return text.size() == kLength && (text[0] == 'E' || text[0] == 'W') &&
           text.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

std::string explain_code(std::string_view code) {
    const auto& codes = diag::all_codes();
    const auto found = std::find_if(codes.begin(), codes.end(),
                                    [&](const diag::CodeInfo& info) { return info.code == code; });
    if (found == codes.end()) return "";
    std::string text =
        fmt::format("{}, {} ({}): {}\n", code, found->name,
                    found->severity == diag::Severity::error ? "error" : "warning", found->summary);
    for (const Example& example : examples())
        if (example.code == code) text += "\nFor example:\n\n" + message_of(example.printed, code);
    return text;
}

int explain_code_command(std::string_view code) {
    const std::string text = explain_code(code);
    if (!text.empty()) return print_text(text);
    std::vector<std::string> codes;
    for (const diag::CodeInfo& info : diag::all_codes()) codes.emplace_back(info.code);
    const auto nearest = diag::nearest_name(code, codes);
    print_error(fmt::format("etlc: there is no code {}; {}\n", data::in_quotes(std::string(code)),
                            nearest ? fmt::format("did you mean {}?", *nearest)
                                    : "expected one as E0204, from a diagnostic"));
    return kWrongCall;
}

}  // namespace etlc::driver
