// Tests rows of Parquet files through the reader process, readers that crash or lie, and paths of
// data sets. tests/datasets/ reads every form of such files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "recordings/datasets/dataset.hpp"
#include "recordings/parquet/table.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

namespace fs = std::filesystem;
using diag::Code;

const std::string kFile = ETLC_SOURCE_DIR "/tests/spec/error/E0850_rows.parquet";

/// Returns the error of reading a column to its end.
std::string message(const std::string& path, const std::vector<std::string>& names) {
    const auto table = Table::open(path, names);
    if (!table) return table.failure().message;
    std::vector<Table::Cell> cells;
    for (;;) {
        const auto more = (*table)->next(cells);
        if (!more) return more.failure().message;
        if (!*more) return "nothing is wrong";
    }
}

TEST(ParquetTable, GivesCells) {
    ::setenv("ETLC_PARQUET_READER", ETLC_PARQUET_READER_PATH, 1);
    const auto table = Table::open(kFile, {"action", "absent", "frame_index"}, "frame_index", 1);
    ASSERT_TRUE(table) << table.failure().message;
    EXPECT_TRUE((*table)->columns()[0].is_list);
    EXPECT_FALSE((*table)->columns()[1].exists);
    std::vector<Table::Cell> cells;
    ASSERT_TRUE(*(*table)->next(cells));
    EXPECT_EQ(cells[0].numbers, (std::vector<double>{1, 0.5}));
    EXPECT_TRUE(cells[1].is_null);
    EXPECT_EQ(cells[2].numbers, std::vector<double>{1});
    EXPECT_FALSE(*(*table)->next(cells));
    EXPECT_FALSE(*(*table)->next(cells));
    EXPECT_EQ(message(ETLC_SOURCE_DIR, {"q"}), "is a directory, expected a file");
}

/// A shell script in place of the reader.
class ParquetReader : public testing::Test {
protected:
    void SetUp() override {
        reader_ = fs::path(testing::TempDir()) /
                  ("etlc_fake_parquet_reader_" + std::to_string(::getpid()) + ".sh");
        ::setenv("ETLC_PARQUET_READER", reader_.c_str(), 1);
    }
    void TearDown() override { fs::remove(reader_); }

    std::string said(const std::string& script) const {
        std::ofstream(reader_) << "#!/bin/sh\n" << script << "\n";
        fs::permissions(reader_, fs::perms::owner_all);
        return message(kFile, {"q"});
    }

    fs::path reader_;
};

TEST_F(ParquetReader, IsNotTrusted) {
    const std::string died = "is damaged or too much to read: the process that read it ";
    const std::string nonsense = "is damaged: what came back from reading it makes no sense";
    const std::string number = R"(printf 'S\007\000\000\000number\n';)";
    const std::string list = R"(printf 'S\014\000\000\000number list\n';)";
    const std::string text = R"(printf 'S\005\000\000\000text\n';)";
    const std::string cell =
        R"(printf 'R\014\000\000\000\001\000\000\000\000\000\000\000\000\000\360\077';)";
    const std::string end = R"(printf 'E\000\000\000\000')";
    EXPECT_EQ(said(number + cell + cell + end), "nothing is wrong");
    EXPECT_EQ(said(list + cell + end), "nothing is wrong");
    EXPECT_EQ(said("kill -BUS $$"), died + "was stopped by signal 7 (Bus error)");
    EXPECT_EQ(said(number + cell), died + "ended too soon, with exit status 0");
    EXPECT_EQ(said(text + cell + end), nonsense) << "its text would end behind the record";
    EXPECT_EQ(said(number + R"(printf 'R\004\000\000\000\002\000\000\000')"), nonsense);
    EXPECT_EQ(said(number + R"(printf 'R\002\000\000\000\002\000')"), nonsense);
    EXPECT_EQ(said(list + R"(printf 'R\004\000\000\000\376\377\377\377')"), nonsense);
    EXPECT_EQ(said(number + R"(printf 'R\000\000\000\000')"), nonsense);
    EXPECT_EQ(said(R"(printf 'S\006\000\000\000numbe\n')"), nonsense);
    EXPECT_EQ(said(R"(printf 'S\000\000\000\000')"), nonsense);
    EXPECT_EQ(said(R"(printf 'S\377\377\377\377')"), nonsense);
    EXPECT_EQ(said(R"(printf 'F\006\000\000\000fa\033[1m')"), "a?[1m");
}

TEST(DatasetPaths, StayInTheFolder) {
    const PathNames names{{{"episode_index", 7}, {"episode_chunk", 0}}, {{"video_key", "top"}}};
    const auto path = [&](const std::string& pattern) {
        const auto made = path_from(pattern, names);
        return made ? *made : made.failure().message;
    };
    EXPECT_EQ(path("videos/{video_key}/{episode_chunk:03d}/e_{episode_index:06d}.mp4"),
              "videos/top/000/e_000007.mp4");
    EXPECT_EQ(path("{episode_index}"), "7");
    EXPECT_EQ(path("/{episode_index}"), "has the path '/7', which leads out of its folder");
    EXPECT_EQ(path("a/../../b"), "has the path 'a/../../b', which leads out of its folder");
    EXPECT_EQ(path(""), "has the path '', which leads out of its folder");
    for (const char* unknown : {"{episode_index", "{}", "{key}", "{episode_index:x}"})
        EXPECT_NE(path(unknown).find("unknown field"), std::string::npos) << unknown;
}

}  // namespace
}  // namespace etlc::recordings
