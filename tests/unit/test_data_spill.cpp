// Data moved to temporary files come back unchanged, few values and many.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "data/spill/spill.hpp"

namespace etlc::data {
namespace {

TEST(SpillFile, GivesBytesFromMemoryAndFromTheFile) {
    SpillFile file;
    std::string all;
    std::mt19937 random(1);
    while (all.size() < 3 * SpillFile::kInMemory) {
        const std::string bytes(random() % 200'000, static_cast<char>(random() % 256));
        EXPECT_EQ(file.append(bytes), all.size());
        all += bytes;
    }
    EXPECT_EQ(file.size(), all.size());
    for (int round = 0; round < 200; ++round) {
        const std::size_t at = random() % all.size();
        std::string part(random() % (all.size() - at), '\0');
        file.read(at, part.data(), part.size());
        EXPECT_TRUE(part == all.substr(at, part.size())) << at;  // the end is never in the file
    }
}

/// Sets another folder for temporary files, for its own lifetime.
class TemporaryFolder {
public:
    explicit TemporaryFolder(const char* path) {
        if (const char* const before = std::getenv("TMPDIR")) before_ = before;
        ::setenv("TMPDIR", path, 1);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        before_.empty() ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", before_.c_str(), 1);
    }

private:
    std::string before_;
};

TEST(SpillFile, SaysWhereThereIsNoRoom) {
    const TemporaryFolder folder("/no/such/folder");
    SpillFile file;
    const std::string half(SpillFile::kInMemory / 2, 'x');
    file.append(half);
    file.append(half);  // still without a file
    try {
        file.append(half);
        FAIL() << "a folder that is not there";
    } catch (const SpillError& error) {
        EXPECT_STREQ(error.what(),
                     "a temporary file in /no/such/folder cannot be made: no such file; TMPDIR "
                     "names another folder");
    }
}

TEST(Spool, GivesAnyValueAndAllInOrder) {
    Spool<std::vector<std::string>> spool;
    const auto value = [](std::size_t i) {
        return std::vector<std::string>(i % 5, std::string(i % 1000, 'a'));
    };
    constexpr std::size_t kMany = 5000;  // more than stay in memory
    for (std::size_t i = 0; i < kMany; ++i) spool.add(value(i));
    ASSERT_EQ(spool.size(), kMany);
    EXPECT_EQ(spool[4711], value(4711));
    std::size_t next = 0;
    spool.for_each([&](std::size_t i, const std::vector<std::string>& found) {
        EXPECT_EQ(i, next++);
        EXPECT_EQ(found, value(i));
    });
    EXPECT_EQ(next, kMany);
}

TEST(Sorted, MergesAsManyRunsAsThereAre) {
    constexpr std::size_t kRun = Sorted<std::uint64_t>::kInMemory / sizeof(std::uint64_t);
    std::mt19937_64 random(2);
    for (const std::size_t many :
         {std::size_t{0}, std::size_t{1}, kRun - 1, kRun, kRun + 1, 2 * kRun, 3 * kRun + 12345}) {
        Sorted<std::uint64_t> sorted;
        std::vector<std::uint64_t> expected(many);
        for (std::uint64_t& value : expected) {
            value = random() >> (random() % 64);  // many are equal
            sorted.add(value);
        }
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(sorted.size(), many);
        for (int pass = 0; pass < 2; ++pass) {
            std::vector<std::uint64_t> found;
            sorted.for_each([&](std::uint64_t value) { found.push_back(value); });
            EXPECT_TRUE(found == expected) << many;
        }
    }
}

}  // namespace
}  // namespace etlc::data
