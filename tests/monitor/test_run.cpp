// `etlc run` on traces too long to hold: memory does not grow with them, and every step is
// answered.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr const char* kSpec =
    "spec long_trace;\n"
    "input x : f32 in [0, 1];\n"
    "predicate p = x > 0.5;\n"
    "predicate q = x < 0.25;\n"
    "monitor answered = G (p -> F[0, 50] q);\n"
    "monitor nested = G (p -> F[0, 9] (q && F[0, 3] p));\n"
    "sliding monitor steady = G[0, 1000] (p -> F[0, 100] q);\n";

class Run : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("etlc-run-" + std::to_string(::getpid()));
        fs::create_directory(folder_);
        std::ofstream(folder_ / "long_trace.etl") << kSpec;
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write_trace(std::uint64_t steps) const {
        std::ofstream trace(folder_ / "trace.csv");
        trace << "x\n";
        std::uint32_t state = 1;
        for (std::uint64_t i = 0; i < steps; ++i) {
            state = state * 1664525U + 1013904223U;
            trace << "0." << (state >> 20U) << "\n";
        }
    }

    /// Peak resident kilobytes of `etlc run`.
    long peak_memory(const std::string& output) const {
        const std::string spec = folder_ / "long_trace.etl";
        const std::string trace = folder_ / "trace.csv";
        const pid_t child = ::fork();
        if (child == 0) {
            ::execl(ETLC_COMMAND, ETLC_COMMAND, "run", spec.c_str(), "--trace", trace.c_str(), "-o",
                    output.c_str(), nullptr);
            ::_exit(127);
        }
        int status = 0;
        rusage usage{};
        EXPECT_EQ(::wait4(child, &status, 0, &usage), child);
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        return usage.ru_maxrss;
    }

    fs::path folder_;
};

TEST_F(Run, MemoryDoesNotGrowWithTheTrace) {
    write_trace(1000);
    const long few = peak_memory("/dev/null");
    write_trace(1000000);
    const long many = peak_memory("/dev/null");
    EXPECT_LT(many - few, 2048)
        << "kilobytes more for a thousand times the steps (the file alone has 6000)";
}

TEST_F(Run, AnswersEveryStepOnce) {
    constexpr std::uint64_t kSteps = 20000;
    write_trace(kSteps);
    const std::string output = folder_ / "verdicts.csv";
    peak_memory(output);
    std::ifstream verdicts(output);
    std::string line;
    ASSERT_TRUE(std::getline(verdicts, line));
    EXPECT_EQ(line, "step,monitor,lower,robustness,upper,status,final,position");
    std::uint64_t rows = 0;
    const std::vector<std::string> monitors{"answered", "nested", "steady"};
    while (std::getline(verdicts, line)) {
        const std::string begin = std::to_string(rows / 3) + "," + monitors[rows % 3] + ",";
        ASSERT_EQ(line.substr(0, begin.size()), begin);
        ++rows;
    }
    EXPECT_EQ(rows, 3 * kSteps);
}

}  // namespace
