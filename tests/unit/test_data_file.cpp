// Tests whole files, the content hash, and text for messages.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "data/arrays/array.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "data/text/text.hpp"
#include "npy_bytes.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using tests::file_bytes;
using tests::TemporaryPath;

TEST(File, ReadsEveryByte) {
    const std::string bytes("a\0b\r\n\xff", 6);
    const TemporaryPath file("x", bytes);
    const auto read = read_file(file.path(), 6, Code::unreadable_thresholds);
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, bytes);
    const auto large = read_file(file.path(), 5, Code::unreadable_thresholds);
    ASSERT_FALSE(large);
    EXPECT_EQ(large.failure().code, Code::unreadable_thresholds);
    EXPECT_EQ(large.failure().message, "is larger than 5 bytes, the most that is read");
}

TEST(File, SaysWhyItCannotRead) {
    const TemporaryPath file("x", "x");
    const auto message = [](const std::string& path) {
        return read_file(path, 9, Code::unreadable_trace).failure().message;
    };
    EXPECT_EQ(message(file.path() + "y"), "no such file");
    EXPECT_EQ(message(file.path() + "/y"), "no such file");
    EXPECT_EQ(message("/"), "is a directory, expected a file");
    EXPECT_EQ(message(std::string(5000, 'x')), "File name too long");
    if (::geteuid() != 0) {  // root may read everything
        ::chmod(file.path().c_str(), 0);
        EXPECT_EQ(message(file.path()), "permission denied");
    }
}

TEST(File, StreamsAreReadOnlyWhereTheyAreMeantToBe) {
    const TemporaryPath pipe("pipe");
    ASSERT_EQ(::mkfifo(pipe.path().c_str(), 0600), 0);
    const auto refused = read_file(pipe.path(), 9, Code::unreadable_trace);  // without waiting
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.failure().message, "is a pipe, expected a file");
    EXPECT_EQ(open_file(pipe.path()).failure().message, "is a pipe, expected a file");
    EXPECT_EQ(hash_of_file(pipe.path(), Code::unreadable_trace).failure().message,
              "is a pipe, expected a file");
    EXPECT_EQ(why_unreadable("/dev/zero"), "is a device, expected a file");
    EXPECT_EQ(why_unreadable("/dev/zero", Streams::taken), std::nullopt);
    const auto empty = read_file("/dev/null", 9, Code::unreadable_trace, Streams::taken);
    ASSERT_TRUE(empty);
    EXPECT_EQ(*empty, "");
}

TEST(File, InFileIsADiagnosticWithItsPlace) {
    const auto diagnostic = in_file({Code::malformed_csv, "what", 3, 4}, "run.csv");
    EXPECT_EQ(diagnostic.code, Code::malformed_csv);
    EXPECT_EQ(diagnostic.message, "what");
    EXPECT_EQ(diagnostic.file, "run.csv");
    EXPECT_EQ(diagnostic.line, 3U);
    EXPECT_EQ(diagnostic.column, 4U);
    EXPECT_FALSE(diagnostic.span);
}

TEST(Hash, PublishedValues) {
    // From the xxHash project's own documentation and test programs.
    EXPECT_EQ(xxh64(""), 0xEF46DB3751D8E999U);
    EXPECT_EQ(xxh64("a"), 0xD24EC4F1A98C6E5BU);
    EXPECT_EQ(xxh64("abc"), 0x44BC2CF5AD770999U);
    EXPECT_EQ(xxh64("Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1U);
}

TEST(Hash, AgreesWithTheReferenceLibrary) {
    // XXH64 of the bytes 0, 1, ... n - 1 with seed n, by libxxhash 0.8.1: every path through the
    // tail.
    const std::pair<std::size_t, std::uint64_t> table[] = {
        {0, 0xef46db3751d8e999},  {1, 0x771917c7f6ee2451},  {4, 0xbbc1c9489fc87eba},
        {8, 0x0dfc1d486cf5e934},  {31, 0xba30fb3300bd71ca}, {32, 0x35dee9a72ef74939},
        {33, 0x4d3992b427942d69}, {63, 0xad2949b4f8374543}, {64, 0x041e5bf40b6caf5a},
        {100, 0xce0bd8dd7405ab42}};
    for (const auto& [n, expected] : table) {
        std::string bytes;
        for (std::size_t i = 0; i < n; ++i) bytes += static_cast<char>(i);
        EXPECT_EQ(xxh64(bytes, n), expected) << n;
    }
}

TEST(Hash, EveryLengthAndBitCounts) {
    std::vector<std::uint64_t> seen;
    for (std::size_t n = 0; n <= 100; ++n) {
        std::string bytes(n, '\0');
        seen.push_back(xxh64(bytes));
        for (std::size_t bit = 0; bit < 8 * n; ++bit) {
            bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
            seen.push_back(xxh64(bytes));
            bytes[bit / 8] = 0;
        }
    }
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
}

TEST(Hash, OfContentDependsOnShapeAndBits) {
    const std::string hash = content_hash({2, 3}, {0, 1, 2, 3, 4, 5});
    EXPECT_EQ(hash, "b08b72ea4df23cb1");  // as computed by the reference library, libxxhash 0.8.1
    EXPECT_NE(hash, content_hash({3, 2}, {0, 1, 2, 3, 4, 5}));
    EXPECT_NE(hash, content_hash({6}, {0, 1, 2, 3, 4, 5}));
    EXPECT_NE(hash, content_hash({2, 3}, {-0.0F, 1, 2, 3, 4, 5}));
    EXPECT_NE(hash, content_hash({2, 3}, {0, 1, 2, 3, 5, 4}));
}

TEST(Quote, EscapesAndCuts) {
    EXPECT_EQ(in_quotes("goal"), "'goal'");
    EXPECT_EQ(in_quotes(""), "''");
    EXPECT_EQ(in_quotes("Z\xc3\xbcrich \xe2\x82\xac \xf0\x9f\x98\x80"),
              "'Z\xc3\xbcrich \xe2\x82\xac \xf0\x9f\x98\x80'");
    EXPECT_EQ(in_quotes(std::string("\0\t\x1b\x7f", 4)), "'\\x00\\x09\\x1b\\x7f'");
    // A C1 control, a lone continuation byte, an overlong form, a surrogate, beyond Unicode, a
    // truncated character.
    EXPECT_EQ(in_quotes("\xc2\x9b\x80\xc0\xaf"), "'\\u{9B}\\x80\\xc0\\xaf'");
    EXPECT_EQ(in_quotes("\xe0\x80\xaf\xed\xa0\x80"), "'\\xe0\\x80\\xaf\\xed\\xa0\\x80'");
    EXPECT_EQ(in_quotes("\xf4\x90\x80\x80\xe2\x82"), "'\\xf4\\x90\\x80\\x80\\xe2\\x82'");
    EXPECT_EQ(in_quotes(std::string(61, 'x')), "'" + std::string(60, 'x') + "...'");
    EXPECT_EQ(in_quotes(std::string(60, 'x')), "'" + std::string(60, 'x') + "'");
    EXPECT_EQ(listed({"a"}), "'a'");
    EXPECT_EQ(listed({"a", "b", "c"}), "'a', 'b' and 'c'");
}

}  // namespace
}  // namespace etlc::data
