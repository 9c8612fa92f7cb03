// Each file is a test: error/CODE_name.etl gives the diagnostics of CODE_name.expected, in brief;
// ok/NAME.etl compiles.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "golden.hpp"

namespace etlc::testing {

namespace {

namespace fs = std::filesystem;

const fs::path kFolder = SPEC_CASES;

const std::vector<std::string>& cases() {
    static const std::vector<std::string> all{
#include "spec_cases.inc"
    };
    return all;
}

std::vector<std::string> cases_in(const std::string& folder) {
    std::vector<std::string> found;
    for (const std::string& name : cases())
        if (name.starts_with(folder + "/")) found.push_back(name);
    return found;
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
    std::string name = fs::path(info.param).stem().string();
    std::replace_if(
        name.begin(), name.end(),
        [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    return name;
}

/// Returns "E0204" for "error/E0204_unknown_name.etl".
std::string code_of(const std::string& name) {
    return fs::path(name).stem().string().substr(0, 5);
}

std::string in_brackets(const std::string& code) {
    return fmt::format("[{}]", code);
}

fs::path expected_of(const std::string& name) {
    return (kFolder / name).replace_extension(".expected");
}

/// A folder that is empty at the start of the test and removed at its end.
class TemporaryFolder {
public:
    explicit TemporaryFolder(const std::string& name)
        : path_(fs::temp_directory_path() / fmt::format("etlc-{}-{}", ::getpid(), name)) {
        fs::create_directory(path_);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }

    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

/// Output and errors of `etlc FILE --check`, run in the folder of the file.
Outcome check(const fs::path& file) {
    return run(fmt::format("'{}' {} --check 2>&1", ETLC_EXECUTABLE, file.filename().string()),
               file.parent_path());
}

/// Returns the last line of etlc's output about these diagnostics, as "2 errors, 1 warning".
std::string summary(const std::map<std::string, int>& told) {
    std::vector<std::string> parts;
    for (const char* kind : {"error", "warning", "note"})
        if (const auto found = told.find(kind); found != told.end())
            parts.push_back(
                fmt::format("{} {}{}", found->second, kind, found->second == 1 ? "" : "s"));
    return fmt::format("{}", fmt::join(parts, ", "));
}

/// Leaves out of the output of etlc what the case repeats. The marked text, behind its position,
/// stands for an excerpt, which is a line of the source and the carets below it; lines that are not
/// ASCII stay. A summary stays only if it counts otherwise.
std::string brief(const std::string& output) {
    static const std::regex source(R"( +\d+ \| ?.*)"), carets(R"( +\| *(\^[\^~]*))"),
        head(R"((\S.*?)(: (?:error|warning|note): .*))"),
        coded(R"(.*: (error|warning|note): .* \[[EW]\d{4}\])");
    const auto is_ascii = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
    std::vector<std::string> lines;
    std::map<std::string, int> told;
    std::istringstream text(output);
    for (std::string line; std::getline(text, line);) {
        std::smatch marks, parts, diagnostic;
        const std::size_t n = lines.size();
        if (!told.empty() && line == summary(told)) {
            told.clear();
        } else if (n >= 2 && std::regex_match(line, marks, carets) &&
                   std::regex_match(lines[n - 1], source) &&
                   std::ranges::all_of(lines[n - 1], is_ascii) &&
                   std::regex_match(lines[n - 2], parts, head)) {
            const auto from = static_cast<std::size_t>(marks.position(1));
            const std::string marked =
                from < lines[n - 1].size()
                    ? lines[n - 1].substr(from, static_cast<std::size_t>(marks.length(1)))
                    : "";
            lines.pop_back();
            lines.back() = fmt::format("{} '{}'{}", parts.str(1), marked, parts.str(2));
        } else {
            if (std::regex_match(line, diagnostic, coded)) ++told[diagnostic.str(1)];
            lines.push_back(line);
        }
    }
    if (!told.empty()) lines.push_back(fmt::format("no line says {}", summary(told)));
    return lines.empty()
               ? ""
               : fmt::format("{}{}", fmt::join(lines, "\n"), output.ends_with('\n') ? "\n" : "");
}

// ---- error/ -------------------------------------------------------------------------------------

class SpecError : public ::testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SpecError);

TEST_P(SpecError, IsDiagnosed) {
    const fs::path file = kFolder / GetParam();
    if (file.extension() == ".sh") {
        const TemporaryFolder folder(file.stem().string());
        const std::string environment =
            fmt::format("ETLC='{}' SPECS='{}'", ETLC_EXECUTABLE, file.parent_path().string());
        const std::string command = fmt::format("{} bash '{}' 2>&1", environment, file.string());
        expect_golden(brief(run(command, folder.path()).output), expected_of(GetParam()));
        return;
    }
    const Outcome outcome = check(file);
    expect_golden(brief(outcome.output), expected_of(GetParam()));
    EXPECT_EQ(outcome.status, code_of(GetParam()).starts_with('W') ? 0 : 1);
}

INSTANTIATE_TEST_SUITE_P(Error, SpecError, ::testing::ValuesIn(cases_in("error")), test_name);

TEST(SpecErrors, EveryCodeHasACaseThatShowsIt) {
    std::set<std::string> shown;
    for (const std::string& name : cases_in("error"))
        if (read_text(expected_of(name)).find(in_brackets(code_of(name))) != std::string::npos)
            shown.insert(code_of(name));
    for (const diag::CodeInfo& info : diag::all_codes())
        EXPECT_TRUE(shown.contains(std::string(info.code)))
            << info.code << " (" << info.name << ") has no tests/spec/error/" << info.code << "_*";
}

TEST(SpecErrors, EveryCaseIsNamedAfterACodeThatItShows) {
    std::set<std::string> codes;
    for (const diag::CodeInfo& info : diag::all_codes()) codes.insert(std::string(info.code));
    for (const std::string& name : cases_in("error")) {
        EXPECT_TRUE(codes.contains(code_of(name))) << name;
        EXPECT_NE(read_text(expected_of(name)).find(in_brackets(code_of(name))), std::string::npos)
            << name;
    }
}

TEST(SpecErrors, EveryExpectedTextHasACase) {
    for (const char* folder : {"error", "ok"}) {
        for (const auto& entry : fs::directory_iterator(kFolder / folder)) {
            fs::path file = entry.path();
            if (file.extension() != ".expected") continue;
            const bool has_case = fs::exists(file.replace_extension(".etl")) ||
                                  fs::exists(file.replace_extension(".sh"));
            EXPECT_TRUE(has_case) << entry.path();
        }
    }
}

// ---- ok/ ----------------------------------------------------------------------------------------

class SpecOk : public ::testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SpecOk);

/// NAME.expected lists the warnings; without warnings there is no such file.
TEST_P(SpecOk, Compiles) {
    const fs::path file = kFolder / GetParam();
    const Outcome outcome = check(file);
    expect_golden(outcome.output, expected_of(GetParam()), true);
    EXPECT_EQ(outcome.status, 0);
}

/// NAME.ast, NAME.graph and so on, if they exist, hold the text of that stage.
TEST_P(SpecOk, EmitsItsGoldens) {
    const fs::path file = kFolder / GetParam();
    for (const std::string stage : {"ast", "graph", "plan", "dot", "report"}) {
        const fs::path golden = fs::path(file).replace_extension(stage);
        if (!fs::exists(golden)) continue;
        const Outcome outcome = run(fmt::format("'{}' {} --emit {} 2>/dev/null", ETLC_EXECUTABLE,
                                                file.filename().string(), stage),
                                    file.parent_path());
        EXPECT_EQ(outcome.status, 0) << stage;
        expect_golden(outcome.output, golden);
    }
}

INSTANTIATE_TEST_SUITE_P(Ok, SpecOk, ::testing::ValuesIn(cases_in("ok")), test_name);

}  // namespace

}  // namespace etlc::testing
