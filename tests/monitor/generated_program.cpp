#include "generated_program.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "generated_source.hpp"
#include "loading.hpp"

namespace etlc::tests {
namespace {

// The warnings promised in docs/generated_code.md.
constexpr const char* kFlags =
    "-std=c++17 -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wpedantic -Werror "
    "-fno-exceptions -fno-rtti";
// All operators in one class exceed the default limits.
constexpr const char* kLimits = "--max-state 16777216 --max-code 16777216 --max-work 67108864";

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream stream(path, std::ios::binary);
    stream << text;
    if (!stream.flush()) ADD_FAILURE() << path << " cannot be written";
}

}  // namespace

GeneratedProgram::GeneratedProgram(const std::string& name, Classes classes)
    : folder_(std::filesystem::path(ETLC_BINARY_DIR) / "tests/monitor/generated" / name),
      classes_(std::move(classes)) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
}

bool GeneratedProgram::command(const std::string& line) {
    const std::string log = (folder_ / "log.txt").string();
    const int status =
        std::system(fmt::format("cd '{}' && {} 2> log.txt", folder_.string(), line).c_str());
    if (status != 0) ADD_FAILURE() << line << "\nexited with " << status << "\n" << read_text(log);
    return status == 0;
}

bool GeneratedProgram::add(const check::Model& model, check::Values values,
                           const std::string& thresholds) {
    models_.push_back(model);
    for (check::Let& let : models_.back().lets) let.telemetry = false;  // no --lets here
    explain_.push_back(values == check::Values::sourced);
    write_text(folder_ / (model.name + ".etl"), std::string(model.file.text()));
    if (!thresholds.empty()) write_text(folder_ / (model.name + ".thresholds.json"), thresholds);
    const char* of_values = values == check::Values::boolean   ? "--values boolean"
                            : values == check::Values::sourced ? "--explain"
                                                               : "";
    return command(fmt::format("'{}' {}.etl -o {}.hpp {} {} {}", ETLC_COMMAND, model.name,
                               model.name, kLimits, of_values, classes_.options));
}

bool GeneratedProgram::compile(const Build& build) {
    emulator_ = build.emulator;
    std::string parts[2];
    std::vector<std::string> names;
    for (std::size_t n = 0; n < models_.size(); ++n) {
        parts[n % 2] += adaptor_source(models_[n], explain_[n], classes_.session);
        names.push_back(models_[n].name);
    }
    parts[1] = fmt::format("#include \"{}.hpp\"\n", names[0]) + parts[1];
    for (int n = 0; n < 2; ++n)
        write_text(folder_ / fmt::format("part{}.cpp", n),
                   "#include \"harness.hpp\"\n#include \"incidents.hpp\"\n" + parts[n]);
    write_text(folder_ / "main.cpp", main_source(names));
    return command(
        fmt::format("{0} {1} {2} {3} -I. -I'{4}/runtime/include' -I'{4}/tests/monitor/driver' "
                    "main.cpp part0.cpp part1.cpp "
                    "'{4}/tests/monitor/driver/harness.cpp' -o program",
                    build.compiler, kFlags, build.flags,
                    build.counts_malloc ? "-DHARNESS_COUNTS_MALLOC" : "", ETLC_SOURCE_DIR));
}

std::optional<std::string> GeneratedProgram::answers(const std::vector<Request>& requests,
                                                     const std::string& arguments) {
    std::string bytes;
    for (const Request& request : requests) bytes += encode(models_[request.spec], request);
    write_text(folder_ / "requests.bin", bytes);
    if (!command(fmt::format("{} ./program {} < requests.bin > answers.bin", emulator_, arguments)))
        return std::nullopt;
    return read_text((folder_ / "answers.bin").string());
}

GeneratedProgram::Result GeneratedProgram::run(const std::vector<Request>& requests,
                                               const std::string& arguments) {
    Result result;
    const auto written = answers(requests, arguments);
    if (!written) return result;
    Decoder decoder(*written);
    for (const Request& request : requests)
        result.answers.push_back(
            decoder.answer(models_[request.spec], explain_[request.spec], request));
    result.allocations = decoder.allocations();
    EXPECT_TRUE(decoder.at_end());
    return result;
}

}  // namespace etlc::tests
