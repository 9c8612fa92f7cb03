// Tests files that appear whole or not at all.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <optional>

#include "data/files/atomic_file.hpp"
#include "npy_bytes.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using tests::file_bytes;
using tests::TemporaryPath;

std::size_t files_beside(const std::string& path) {
    const std::filesystem::directory_iterator files(std::filesystem::path(path).parent_path());
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

TEST(AtomicWrite, MakesOrReplacesTheFile) {
    const TemporaryPath file("out.hpp");
    for (const std::string bytes : {"first", "second, longer"}) {
        EXPECT_FALSE(write_file_atomically(file.path(), bytes, Code::unreadable_trace));
        EXPECT_EQ(file_bytes(file.path()), bytes);
        EXPECT_EQ(files_beside(file.path()), 1U);
    }
}

TEST(AtomicWrite, NothingShowsBeforeItIsComplete) {
    const TemporaryPath file("out.csv", "old");
    {
        auto writer = AtomicFile::create(file.path(), Code::unreadable_trace);
        ASSERT_TRUE(writer);
        EXPECT_FALSE(writer->write("new"));
        EXPECT_EQ(file_bytes(file.path()), "old");
    }
    EXPECT_EQ(file_bytes(file.path()), "old");
    EXPECT_EQ(files_beside(file.path()), 1U);
}

TEST(AtomicWrite, TwoWritersDoNotMix) {
    const TemporaryPath file("out.csv");
    auto one = AtomicFile::create(file.path(), Code::unreadable_trace);
    auto two = AtomicFile::create(file.path(), Code::unreadable_trace);
    ASSERT_TRUE(one && two);
    EXPECT_FALSE(one->write("one"));
    EXPECT_FALSE(two->write("two"));
    EXPECT_FALSE(one->commit());
    EXPECT_EQ(file_bytes(file.path()), "one");
    EXPECT_FALSE(two->commit());
    EXPECT_EQ(file_bytes(file.path()), "two");
    EXPECT_EQ(files_beside(file.path()), 1U);
}

TEST(AtomicWrite, ReplacesWhatALinkPointsTo) {
    const TemporaryPath file("real", "old");
    const std::string link = file.path() + ".link";
    std::filesystem::create_symlink(file.path(), link);
    EXPECT_FALSE(write_file_atomically(link, "new", Code::unreadable_trace));
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(file_bytes(file.path()), "new");
}

TEST(AtomicWrite, DevicesAreWrittenTo) {
    EXPECT_FALSE(write_file_atomically("/dev/null", "x", Code::unreadable_trace));
    const auto full = write_file_atomically("/dev/full", "x", Code::unreadable_trace);
    ASSERT_TRUE(full);
    EXPECT_EQ(full->message, "cannot be written: no space left on the device");
}

TEST(AtomicWrite, StandardOutputIsAppendedTo) {
    const TemporaryPath file("log", "before\n");
    std::fflush(stdout);
    const int kept = ::dup(STDOUT_FILENO);
    const int log = ::open(file.path().c_str(), O_WRONLY | O_APPEND);
    ::dup2(log, STDOUT_FILENO);
    ::close(log);
    const auto failure = write_file_atomically("/dev/stdout", "written\n", Code::unreadable_trace);
    const bool more = ::write(STDOUT_FILENO, "after\n", 6) == 6;
    ::dup2(kept, STDOUT_FILENO);
    ::close(kept);
    EXPECT_TRUE(!failure && more);
    EXPECT_EQ(file_bytes(file.path()), "before\nwritten\nafter\n");
}

TEST(AtomicWrite, SaysWhyItCannotWrite) {
    const TemporaryPath file("x", "x");
    const auto message = [](const std::string& path) {
        return write_file_atomically(path, "x", Code::unreadable_trace)->message;
    };
    EXPECT_EQ(message(file.path() + ".d/out"), "cannot be written: no such folder");
    EXPECT_EQ(message(file.path() + "/out"), "cannot be written: no such folder");
    EXPECT_EQ(message("/"), "cannot be written: is a directory, expected a file");
    EXPECT_EQ(file_bytes(file.path()), "x");
    EXPECT_EQ(files_beside(file.path()), 1U);
}

TEST(AtomicWrite, ALinkToNothingIsFollowed) {
    const TemporaryPath file("real");
    const std::string link = file.path() + ".link";
    std::filesystem::create_symlink("real", link);
    EXPECT_FALSE(write_file_atomically(link, "new", Code::unreadable_trace));
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(file_bytes(file.path()), "new");
    const std::string loop = file.path() + ".loop";
    std::filesystem::create_symlink(loop, loop);
    EXPECT_TRUE(write_file_atomically(loop, "new", Code::unreadable_trace));
}

TEST(AtomicWrite, PermissionsAreKept) {
    const TemporaryPath file("secret", "old");
    for (const mode_t mode : {0600U, 0640U, 0755U}) {
        ::chmod(file.path().c_str(), mode);
        EXPECT_FALSE(write_file_atomically(file.path(), "new", Code::unreadable_trace));
        struct stat status {};
        ASSERT_EQ(::stat(file.path().c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 0777U, mode);
    }
}

TEST(AtomicWrite, NamesMayBeAsLongAsTheFileSystemTakes) {
    const TemporaryPath file(std::string(255, 'n'));
    for (const std::string bytes : {"first", "second"}) {
        const auto failure = write_file_atomically(file.path(), bytes, Code::unreadable_trace);
        EXPECT_FALSE(failure) << failure->message;
        EXPECT_EQ(file_bytes(file.path()), bytes);
    }
    EXPECT_EQ(files_beside(file.path()), 1U);
}

TEST(AtomicWrite, AKilledWriterLeavesNothing) {
    const TemporaryPath file("out", "old");
    const pid_t writer = ::fork();
    if (writer == 0) {
        auto written = AtomicFile::create(file.path(), Code::unreadable_trace);
        if (written) written->write("new");
        ::raise(SIGKILL);
    }
    ::waitpid(writer, nullptr, 0);
    EXPECT_EQ(file_bytes(file.path()), "old");
    EXPECT_EQ(files_beside(file.path()), 1U);
}

/// Two files of a folder.
class SeveralFiles : public ::testing::Test {
protected:
    void create() {
        for (const char* name : {"a", "b"}) {
            auto file = AtomicFile::create(path(name), Code::unreadable_trace);
            ASSERT_TRUE(file);
            EXPECT_FALSE(file->write("new"));
            files_.push_back(std::make_unique<AtomicFile>(std::move(*file)));
        }
    }
    std::optional<Uncommitted> commit() { return commit_all({files_[0].get(), files_[1].get()}); }
    std::string path(const std::string& name) const { return folder_.path() + name; }

    const TemporaryPath folder_{""};
    std::vector<std::unique_ptr<AtomicFile>> files_;
};

TEST_F(SeveralFiles, AllTakeTheirNames) {
    EXPECT_FALSE(write_file_atomically(path("a"), "old", Code::unreadable_trace));
    create();
    EXPECT_FALSE(commit());
    EXPECT_EQ(file_bytes(path("a")), "new");
    EXPECT_EQ(file_bytes(path("b")), "new");
    EXPECT_EQ(files_beside(path("a")), 2U);
}

TEST_F(SeveralFiles, AFailureNamesTheFileAndLeavesNoOther) {
    create();
    std::filesystem::create_directory(path("b"));
    const auto uncommitted = commit();
    ASSERT_TRUE(uncommitted);
    EXPECT_EQ(uncommitted->file, 1U);
    files_.clear();
    EXPECT_EQ(files_beside(path("a")), 2U);
}

TEST_F(SeveralFiles, NothingHangsOnTheLock) {
    create();
    const int folder = ::open(folder_.path().c_str(), O_RDONLY | O_DIRECTORY);
    ::flock(folder, LOCK_EX);
    EXPECT_FALSE(commit());
    ::close(folder);
    EXPECT_EQ(file_bytes(path("b")), "new");
}

}  // namespace
}  // namespace etlc::data
