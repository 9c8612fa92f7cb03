// Tests files of targets: only the right bytes, complete and aligned, are ready, whether mapped or
// given by pointer.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "etlmon/hosted/mapped_targets.hpp"

namespace {

using etlmon::TargetsState;

constexpr std::size_t kSize = 256;
using Targets = etlmon::Targets<kSize, 0xc12570868ceac336u>;
using Mapped = etlmon::MappedTargets<Targets>;

struct Bytes {
    alignas(64) std::uint8_t at[2 * kSize];
};
Bytes right_bytes() {
    Bytes bytes{};
    for (std::size_t i = 0; i < kSize; ++i) bytes.at[i] = static_cast<std::uint8_t>(i * 37 + 1);
    return bytes;
}

/// A file below the temporary folder, removed at the end.
class File {
public:
    explicit File(const std::string& name)
        : path_(std::filesystem::temp_directory_path() /
                ("etlmon-" + std::to_string(::getpid()) + name)) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() { std::filesystem::remove_all(path_); }

    void write(const std::uint8_t* bytes, std::size_t size) const {
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes), static_cast<long>(size));
    }
    std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

TEST(Targets, OfTheRightBytesAreReady) {
    const Bytes bytes = right_bytes();
    const Targets targets(bytes.at, kSize);
    EXPECT_TRUE(targets.ready());
    EXPECT_EQ(targets.state(), TargetsState::ready);
    EXPECT_EQ(static_cast<const void*>(targets.rows()), bytes.at);
}

TEST(Targets, WithoutBytesAreNot) {
    EXPECT_EQ(Targets().state(), TargetsState::absent);
    EXPECT_EQ(Targets().rows(), nullptr);
    EXPECT_EQ(Targets(nullptr, kSize).state(), TargetsState::absent);
}

TEST(Targets, OfEveryOtherSizeAreNot) {
    const Bytes bytes = right_bytes();
    for (std::size_t size = 0; size <= 2 * kSize; ++size) {
        if (size == kSize) continue;
        const Targets targets(bytes.at, size);
        EXPECT_EQ(targets.state(), TargetsState::wrong_size) << size;
        EXPECT_EQ(targets.rows(), nullptr) << size;
    }
}

TEST(Targets, WithAnyBitChangedAreNot) {
    for (std::size_t bit = 0; bit < 8 * kSize; ++bit) {
        Bytes bytes = right_bytes();
        bytes.at[bit / 8] = static_cast<std::uint8_t>(bytes.at[bit / 8] ^ 1U << bit % 8);
        const Targets targets(bytes.at, kSize);
        EXPECT_EQ(targets.state(), TargetsState::wrong_checksum) << bit;
        EXPECT_EQ(targets.rows(), nullptr) << bit;
    }
}

TEST(Targets, WithStripesInAnotherOrderAreNot) {
    for (std::size_t a = 0; a < kSize; a += 32) {
        for (std::size_t b = a + 32; b < kSize; b += 32) {
            Bytes bytes = right_bytes();
            std::swap_ranges(bytes.at + a, bytes.at + a + 32, bytes.at + b);
            EXPECT_FALSE(Targets(bytes.at, kSize).ready()) << a << ' ' << b;
        }
    }
}

TEST(Targets, ThatAreMisalignedAreNot) {
    const Bytes right = right_bytes();
    for (std::size_t shift = 1; shift < 64; ++shift) {
        Bytes bytes{};
        std::copy_n(right.at, kSize, bytes.at + shift);
        EXPECT_EQ(Targets(bytes.at + shift, kSize).state(), TargetsState::misaligned) << shift;
    }
}

TEST(MappedTargets, AreThoseOfTheFile) {
    const File file("right");
    const Bytes bytes = right_bytes();
    file.write(bytes.at, kSize);
    const Mapped mapped(file.path().c_str());
    EXPECT_TRUE(mapped.ready());
    EXPECT_EQ(mapped.error(), 0);
    EXPECT_STREQ(mapped.message(), "ready");
    EXPECT_EQ(memcmp(mapped.targets().rows(), bytes.at, kSize), 0);
}

TEST(MappedTargets, OfAFileThatIsReplacedStay) {
    const File file("replaced"), other("other");
    Bytes bytes = right_bytes();
    file.write(bytes.at, kSize);
    const Mapped mapped(file.path().c_str());
    const Bytes zeros{};
    other.write(zeros.at, 1);
    std::filesystem::rename(other.path(), file.path());
    EXPECT_EQ(memcmp(mapped.targets().rows(), bytes.at, kSize), 0);
    EXPECT_EQ(Mapped(file.path().c_str()).state(), TargetsState::wrong_size);
}

TEST(MappedTargets, OfDamagedFilesAreNot) {
    const Bytes right = right_bytes();
    for (std::size_t size = 0; size <= kSize + 64; ++size) {
        if (size == kSize) continue;
        const File file("size");
        file.write(right.at, size);
        const Mapped mapped(file.path().c_str());
        EXPECT_EQ(mapped.state(), TargetsState::wrong_size) << size;
        EXPECT_FALSE(mapped.ready());
    }
    for (std::size_t at = 0; at < kSize; ++at) {
        Bytes bytes = right;
        ++bytes.at[at];
        const File file("byte");
        file.write(bytes.at, kSize);
        const Mapped mapped(file.path().c_str());
        EXPECT_EQ(mapped.state(), TargetsState::wrong_checksum) << at;
        EXPECT_EQ(mapped.targets().rows(), nullptr);
    }
}

TEST(MappedTargets, OfNoFileSayWhy) {
    const Mapped absent("/nowhere/at.targets.bin");
    EXPECT_EQ(absent.error(), ENOENT);
    EXPECT_FALSE(absent.ready());
    EXPECT_STREQ(absent.message(), "No such file or directory");
    const Mapped folder("/");
    EXPECT_EQ(folder.error(), EISDIR);
    const File pipe("pipe");
    ASSERT_EQ(::mkfifo(pipe.path().c_str(), 0600), 0);
    EXPECT_FALSE(Mapped(pipe.path().c_str()).ready());  // without waiting for a writer
}

}  // namespace
