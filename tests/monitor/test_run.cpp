// Tests `etlc run` on very long traces: memory does not grow with them, and every step gets a
// verdict.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr const char* kWatchSpec =
    "spec watch;\n"
    "rate 4 Hz;\n"
    "input x : f32 in [0, 1] hold 1;\n"
    "input y : f32;\n"
    "predicate near = x > 0.5;\n"
    "sliding monitor soon = F[0, 1] near;\n"
    "monitor above = G x - y > -2;\n";
constexpr const char* kWatchTrace = "x,y\n0.25,0\n0.75,0\n2,0\n,1\n0,0.5\n";

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

    /// Returns the output of `etlc run` for a short trace.
    std::string watched(const std::string& options, const std::string& spec = kWatchSpec,
                        const std::string& samples = kWatchTrace) const {
        std::ofstream(folder_ / "watch.etl") << spec;
        std::ofstream(folder_ / "watch.csv") << samples;
        return said("watch.etl --trace watch.csv " + options);
    }

    /// Returns the output of `etlc run` with these words.
    std::string said(const std::string& words) const {
        const std::string call =
            std::string("cd '") + folder_.string() + "' && '" + ETLC_COMMAND + "' run " + words;
        std::FILE* const pipe = ::popen(call.c_str(), "r");
        std::string text;
        for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
        EXPECT_EQ(::pclose(pipe), 0);
        return text;
    }

    /// Returns the peak resident kilobytes of `etlc run`.
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

TEST_F(Run, RowsSayPositionTimeAndDistances) {
    EXPECT_EQ(watched("--finish --distances"),
              "step,monitor,lower,robustness,upper,status,final,position,time,distance_near,"
              "distance_x - y\n"
              "0,soon,,,,undecided,0,,0,0.25,0.25\n"
              "0,above,-inf,2.25,2.25,satisfied,0,0,0,0.25,0.25\n"
              "1,soon,0.25,0.25,0.25,satisfied,1,0,0.25,0.75,0.75\n"
              "1,above,-inf,2.25,2.25,satisfied,0,0,0.25,0.75,0.75\n"
              "2,soon,0.25,0.25,0.25,satisfied,1,1,0.5,0.75,0.75\n"
              "2,above,-inf,2.25,2.25,satisfied,0,0,0.5,0.75,0.75\n"
              "3,soon,0.25,0.25,0.5,satisfied,1,2,0.75,,\n"
              "3,above,-inf,-inf,2.25,unknown,0,0,0.75,,\n"
              "4,soon,-0.5,-0.5,0.5,unknown,1,3,1,0,-0.5\n"
              "4,above,-inf,-inf,1.5,unknown,0,0,1,0,-0.5\n"
              "5,soon,-0.5,-0.5,-0.5,violated,1,4,1.25,,\n"
              "5,above,-inf,-inf,1.5,unknown,0,0,1.25,,\n");
}

/// A let that looks ahead has no column, and an unknown one an empty cell; comparisons of one
/// expression share a column.
TEST_F(Run, RowsSayWhatLetsDo) {
    const std::string spec =
        "spec watch;\n"
        "input x : f32;\n"
        "let low = x <= 1 && O[0, 1] x <= 0.5;\n"
        "let soon = F[0, 2] low;\n"
        "monitor m = G x <= 2;\n";
    EXPECT_EQ(watched("--lets --distances", spec, "x\n0.25\n0.75\n\"\"\n2\n"),
              "step,monitor,lower,robustness,upper,status,final,position,distance_x,"
              "robustness_low\n"
              "0,m,-inf,1.75,1.75,satisfied,0,0,0.25,0.25\n"
              "1,m,-inf,1.25,1.25,satisfied,0,0,0.75,0.25\n"
              "2,m,-inf,-inf,1.25,unknown,0,0,,\n"
              "3,m,-inf,-inf,0,unknown,0,0,2,-1.5\n");
}

TEST_F(Run, SummaryCountsVerdictsAndSamples) {
    const std::string rest =
        "above: unknown so far, robustness -inf; unknown on 2 steps\n"
        "5 steps\n"
        "input x: 1 missing, 1 out of range, of which 1 held\n";
    EXPECT_EQ(
        watched("--summary"),
        "soon: never violated, least robustness 0.25 at step 0 (0 s); unknown on 1 step\n" + rest);
    EXPECT_EQ(watched("--summary --finish -o rows.csv"),
              "soon: violated at 1 of 5 positions, first at step 4 (1 s), least robustness -0.5 at "
              "step 4 (1 s); unknown on 1 step\n" +
                  rest);
    EXPECT_TRUE(fs::exists(folder_ / "rows.csv"));
}

/// Neither the state nor the counts of the first episode matter to the second.
TEST_F(Run, StepsSeveralEpisodesOneAfterAnother) {
    const auto rows_of = [](const std::string& text, const std::string& first_cell) {
        std::string rows;
        std::istringstream lines(text.substr(text.find('\n') + 1));
        for (std::string line; std::getline(lines, line);) rows += first_cell + line + "\n";
        return rows;
    };
    const std::string other = "x,y\n0,3\n0.75,0\n,\n";
    const std::string head = watched("").substr(0, watched("").find('\n'));
    const std::string first = watched("--finish --distances");
    const std::string summary = watched("--summary");
    const std::string changes = watched("--changes");
    fs::create_directory(folder_ / "runs");
    fs::copy_file(folder_ / "watch.csv", folder_ / "runs/a, 1.csv");
    const std::string second = watched("--finish --distances", kWatchSpec, other);
    const std::string summaries =
        "runs/a, 1.csv\n" + summary + "runs/b.csv\n" + watched("--summary", kWatchSpec, other);
    fs::copy_file(folder_ / "watch.csv", folder_ / "runs/b.csv");
    EXPECT_EQ(said("watch.etl --data runs --finish --distances"),
              "trace," + first.substr(0, first.find('\n') + 1) +
                  rows_of(first, "\"runs/a, 1.csv\",") + rows_of(second, "runs/b.csv,"));
    EXPECT_EQ(said("watch.etl --data runs --summary"), summaries);
    EXPECT_EQ(said("watch.etl --data runs/b.csv").substr(0, head.size() + 6), "trace," + head);
    EXPECT_EQ(said("watch.etl --data 'runs/a*' --changes"), "runs/a, 1.csv\n" + changes);
}

/// An int8 has no -0, a float32 has.
TEST_F(Run, CountsStaleSamples) {
    const std::string spec =
        "spec watch;\n"
        "rate 4 Hz;\n"
        "input x : f32 hold 1, stale after 0.5 s;\n"
        "input z : i8[2] scale 0.5, stale after 1;\n"
        "target origin = [[0, 0]];\n"
        "sliding monitor low = x < 1;\n"
        "sliding monitor near = l2(z, origin) <= 1;\n";
    EXPECT_EQ(watched("--summary", spec, "x,z[0],z[1]\n0,0,1\n0,-0,1\n,,\n0,0,1\n0,1,0\n-0,0,1\n"),
              "low: never violated, least robustness 1 at step 0 (0 s); unknown on 2 steps\n"
              "near: never violated, least robustness 0.5 at step 0 (0 s); unknown on 3 steps\n"
              "6 steps\n"
              "input x: 1 missing, 2 stale, of which 1 held\n"
              "input z: 1 missing, 2 stale\n");
}

}  // namespace
