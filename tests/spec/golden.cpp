#include "golden.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace etlc::testing {

namespace {

bool updating() {
    const char* update = std::getenv("ETLC_UPDATE");
    return update != nullptr && std::string(update) == "1";
}

}  // namespace

Outcome run(const std::string& command, const std::filesystem::path& folder) {
    Outcome outcome;
    FILE* pipe = ::popen(("cd '" + folder.string() + "' && " + command).c_str(), "r");
    if (pipe == nullptr) return outcome;
    std::array<char, 4096> buffer;
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
        outcome.output.append(buffer.data(), n);
    const int status = ::pclose(pipe);
    if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
    return outcome;
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

void expect_golden(const std::string& found, const std::filesystem::path& golden,
                   bool may_be_absent) {
    if (updating()) {
        if (found.empty() && may_be_absent)
            std::filesystem::remove(golden);
        else
            std::ofstream(golden, std::ios::binary) << found;
        return;
    }
    const bool absent = !std::filesystem::exists(golden);
    EXPECT_TRUE(!absent || (may_be_absent && found.empty()))
        << golden << " is missing; ETLC_UPDATE=1 writes it";
    EXPECT_EQ(found, read_text(golden)) << "ETLC_UPDATE=1 rewrites " << golden;
}

}  // namespace etlc::testing
