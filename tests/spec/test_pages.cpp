// Tests pages made from tables: docs/diagnostics.md from codes.def, docs/command_line.md from the
// options.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "diag/diag.hpp"
#include "driver/codes/explain_code.hpp"
#include "driver/manual/manual.hpp"
#include "golden.hpp"

namespace etlc::testing {

namespace {

std::string_view group_title(std::string_view code) {
    if (code.starts_with('W')) return "Warnings";
    static const std::map<std::string_view, std::string_view> titles{
        {"E01", "Text and syntax"},
        {"E02", "Names"},
        {"E03", "Types and numbers"},
        {"E04", "Targets and other data that a spec loads"},
        {"E05", "Time"},
        {"E06", "Thresholds"},
        {"E07", "Limits"},
        {"E08", "Traces and episodes"},
        {"E09", "Output and memory"},
        {"E10", "Images, video and encoders"},
        {"E11", "Parts of a result"}};
    const auto found = titles.find(code.substr(0, 3));
    return found == titles.end() ? std::string_view("Others") : found->second;
}

std::string table() {
    std::string text = R"(# Diagnostics

Every error and warning of `etlc` has a code.
This table is made from base/diag/codes.def; a test keeps the two equal, and `ETLC_UPDATE=1`
rewrites it.
`etlc --explain E0204` says what a code means, with an example of its message.

| exit status | |
| --- | --- |
| 0 | all that was asked for is there |
| 1 | something is missing: see the diagnostics |
| 2 | the call is wrong |
| 3 | etlc itself is at fault |

Status 1 means that the spec or its data are wrong, that memory is too short, or that some of the
output or of the diagnostics could not be written.
Warnings leave it at 0, unless `-Werror` is given.

Warnings about the spec come from `etlc SPEC.etl`, with `--check` or when it makes a header.
`run`, `calibrate` and `evaluate` use a spec many times and tell only what is wrong with the data,
unless `-Werror` is given.

Close standard error (`2>&-`) to get no diagnostics.
When nobody reads standard output any more (`etlc run ... | head`), SIGPIPE ends etlc as it ends
other tools: the shell says 141.
)";
    std::string_view group;
    for (const diag::CodeInfo& info : diag::all_codes()) {
        if (group_title(info.code) != group) {
            group = group_title(info.code);
            text += fmt::format(
                "\n## {}\n\n| code | name | what it is about |\n| --- | --- | --- |\n", group);
        }
        std::string summary(info.summary);
        for (std::size_t at = 0; (at = summary.find('|', at)) != std::string::npos; at += 2)
            summary.insert(at, "\\");
        text += fmt::format("| {} | {} | {} |\n", info.code, info.name, summary);
    }
    return text;
}

TEST(Diagnostics, TheTableIsThatOfTheCode) {
    expect_golden(table(), std::filesystem::path(ETLC_SOURCE_DIR) / "docs" / "diagnostics.md");
}

TEST(CommandLine, ThePageIsThatOfTheTableOfOptions) {
    expect_golden(driver::command_line_page(),
                  std::filesystem::path(ETLC_SOURCE_DIR) / "docs" / "command_line.md");
}

TEST(CommandLine, ThePythonPackageHasTheTableOfOptions) {
    expect_golden(driver::python_options(),
                  std::filesystem::path(ETLC_SOURCE_DIR) / "python" / "etlc" / "_options.py");
}

TEST(Diagnostics, CodesAreSortedAndUnique) {
    const auto& codes = diag::all_codes();
    for (std::size_t i = 1; i < codes.size(); ++i) EXPECT_LT(codes[i - 1].code, codes[i].code);
}

TEST(Diagnostics, CodesSayTheirSeverity) {
    for (const diag::CodeInfo& info : diag::all_codes())
        EXPECT_EQ(info.code.starts_with('W'), info.severity == diag::Severity::warning)
            << info.code;
}

TEST(Diagnostics, NamesAreUnique) {
    std::set<std::string_view> names;
    for (const diag::CodeInfo& info : diag::all_codes())
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
}

TEST(Diagnostics, EveryCodeIsExplainedWithAnExample) {
    for (const diag::CodeInfo& info : diag::all_codes()) {
        const std::string text = driver::explain_code(info.code);
        EXPECT_NE(text.find(info.summary), std::string::npos) << info.code;
        EXPECT_NE(text.find(fmt::format("[{}]", info.code)), std::string::npos) << text;
    }
    EXPECT_EQ(driver::explain_code("E0000"), "");
}

}  // namespace

}  // namespace etlc::testing
