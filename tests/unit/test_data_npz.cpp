// Tests .npz files: stored and deflated members, keys, and inconsistent archives.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "data/arrays/array.hpp"
#include "npy_bytes.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using tests::floats;
using tests::npy;
using tests::parse_npz;
using tests::patched;
using tests::zip_of;

const std::string kArchives = ETLC_SOURCE_DIR "/tests/unit/data/";

TEST(Npz, StoredAndDeflatedGiveTheSame) {
    for (const char* file : {"stored.npz", "deflated.npz"}) {
        for (const char* key : {"goal", "half", "turned"}) {
            const auto array = read_npz(kArchives + file, key);
            ASSERT_TRUE(array) << array.failure().message;
            EXPECT_EQ(array->shape_text(), "(3, 4)");
            for (int k = 0; k < 12; ++k)
                EXPECT_EQ(array->values[k], (k - 2) * 0.5) << file << " " << key << " " << k;
        }
    }
}

TEST(Npz, TheOnlyArrayNeedsNoKey) {
    ASSERT_TRUE(read_npz(kArchives + "single.npz", ""));
    const auto which = read_npz(kArchives + "stored.npz", "");
    ASSERT_FALSE(which);
    EXPECT_EQ(which.failure().code, Code::no_such_array);
    EXPECT_EQ(which.failure().message,
              "holds 3 arrays, 'goal', 'half' and 'turned'; expected the key of one of them");
}

const std::string kTwo = floats({1, 2});

/// Returns the archive of one array `z`, with `from` replaced by `to` in both of its headers.
std::string archive(bool deflated = true) {
    return zip_of({{"z.npy", npy("<f4", "(2,)", kTwo), deflated}});
}

struct BrokenArchive {
    std::string what;
    std::string bytes;
    std::string key;
    Code code;
    std::string message;
};

std::vector<BrokenArchive> broken_archives() {
    const std::string array = npy("<f4", "(2,)", kTwo);
    const std::string stored = archive(false);
    const std::string two_z =
        patched(zip_of({{"z1.npy", array}, {"z2.npy", array}}), "z2.npy", "z1.npy");
    // The central directory's copy of the header has the method at offset 10, the local one at
    // offset 8.
    std::string method = stored;
    method[8] = 12;
    method[stored.find("PK\x01\x02") + 10] = 12;
    const std::string wrong_data = patched(stored, kTwo, floats({1, 3}));
    const std::string size = tests::little_endian(array.size(), 4);
    std::vector<tests::Member> many;
    for (int i = 0; i < 12; ++i) many.push_back({fmt::format("a{}.npy", i), array});
    return {
        {"empty", "", "z", Code::malformed_archive, "is no .npz file: not a zip archive"},
        {"no zip", array, "z", Code::malformed_archive, "is no .npz file: not a zip archive"},
        {"no arrays", zip_of({{"readme.txt", "x"}}), "z", Code::no_such_array,
         "holds no arrays, expected 'z'"},
        {"no arrays, no key", zip_of({{"readme.txt", "x"}}), "", Code::no_such_array,
         "holds no arrays"},
        {"missing key", zip_of({{"goal_a.npy", array}, {"goal_b.npy", array}}), "gaol_a",
         Code::no_such_array,
         "has no array 'gaol_a'; it holds 'goal_a' and 'goal_b'; did you mean 'goal_a'?"},
        {"missing key of many", zip_of(many), "other", Code::no_such_array,
         "has no array 'other'; it holds 'a0', 'a1', 'a2', 'a3', 'a4', 'a5', 'a6', 'a7', 'a8', "
         "'a9' and 2 more"},
        {"key twice", two_z, "z1", Code::malformed_archive, "holds two arrays named 'z1'"},
        {"encrypted", zip_of({{"z.npy", array, true, true}}), "z", Code::malformed_archive,
         "array 'z': is encrypted, expected plain members"},
        {"method", method, "z", Code::malformed_archive,
         "array 'z': is packed by zip method 12, expected 0 (stored) or 8 (deflated)"},
        {"checksum", wrong_data, "z", Code::malformed_archive,
         "array 'z': archive is damaged: CRC error"},
        {"header promises more than the entry has",
         zip_of({{"z.npy", npy("<f4", "(250000000,)", kTwo)}}), "z", Code::wrong_array_size,
         "array 'z': is cut short: float32 of shape (250000000,) takes 1000000000 bytes, 8 are "
         "there"},
        {"entry has more than the header promises",
         zip_of({{"z.npy", npy("<f4", "(1,)", std::string(1 << 24, '\0'))}}), "z",
         Code::wrong_array_size,
         "array 'z': has bytes left over: float32 of shape (1,) takes 4 bytes, 16777216 are there"},
        {"not an array", zip_of({{"z.npy", "hello, hello"}}), "z", Code::malformed_array,
         "array 'z': is no .npy array: begins with 'hello,', expected '\\x93NUMPY'"},
        {"directory says the member is larger",
         patched(stored, size, tests::little_endian(array.size() + 4, 4)), "z",
         Code::malformed_archive, "archive is damaged: its directory makes no sense"},
    };
}

TEST(Npz, EveryFaultHasItsMessage) {
    for (const BrokenArchive& one : broken_archives()) {
        const auto array = parse_npz(one.bytes, one.key);
        ASSERT_FALSE(array) << one.what;
        EXPECT_EQ(array.failure().code, one.code) << one.what;
        EXPECT_EQ(array.failure().message, one.message) << one.what;
    }
}

/// Adds `by` to the little-endian number of 4 bytes at `at`.
std::string raised(std::string bytes, std::size_t at, std::size_t by) {
    std::uint64_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
    return bytes.replace(at, 4, tests::little_endian(value + by, 4));
}

/// Inserts `more` at `at`, at the beginning or before the directory; the offsets stay right.
std::string moved(const std::string& archive, std::size_t at, const std::string& more) {
    const std::size_t directory = archive.find("PK\x01\x02");
    std::string bytes = raised(archive, archive.size() - 6, more.size());
    if (at == 0) bytes = raised(bytes, directory + 42, more.size());
    return bytes.insert(at, more);
}

std::string with_comment(std::string archive, const std::string& comment) {
    return archive.replace(archive.size() - 2, 2, tests::little_endian(comment.size(), 2)) +
           comment;
}

TEST(Npz, OneArchiveAndNothingElse) {
    const std::string one = archive(false);
    const std::string other = zip_of({{"z.npy", npy("<f4", "(2,)", floats({3, 4})), false}});
    const std::size_t directory = one.find("PK\x01\x02");
    std::string renamed = one;
    renamed[30] = 'y';  // in the member's own header
    const std::string expected = ", expected one archive and nothing else";
    const std::vector<std::pair<std::string, std::string>> refused{
        {one + other, "has bytes around its directory" + expected},
        {moved(other, 0, one), "has bytes before its first member" + expected},
        {moved(one, 0, "#!"), "has bytes before its first member" + expected},
        {moved(one, directory, "hidden"), "has bytes between its members" + expected},
        {one + "x", "has bytes behind its end" + expected},
        {with_comment(one, other), "has bytes around its directory" + expected},
        {with_comment(one, "PK\x05\x06"), "has bytes behind its end" + expected},
        {renamed, "has a member that is 'y.npy' in one place and 'z.npy' in another"},
    };
    for (const auto& [bytes, message] : refused) {
        const auto array = parse_npz(bytes, "z");
        ASSERT_FALSE(array) << message << ": " << array->values[0];
        EXPECT_EQ(array.failure().code, Code::malformed_archive) << message;
        EXPECT_EQ(array.failure().message, message);
    }
    EXPECT_TRUE(parse_npz(with_comment(one, "made by hand"), "z"));
}

/// Returns an archive of one array that has the bytes of the archive `inner`.
std::string around(const std::string& inner) {
    return zip_of({{"z.npy", npy("|u1", "(" + std::to_string(inner.size()) + ",)", inner), false}});
}

TEST(Npz, AnArchiveInAMemberIsNotTakenForTheArchive) {
    const std::string inner = archive(false);
    const std::string outer = around(inner);
    const auto array = parse_npz(outer, "z");
    ASSERT_TRUE(array) << array.failure().message;
    EXPECT_EQ(array->values.size(), inner.size());
    // Its offsets may be right in the outer archive, and its comment may be everything after it.
    const std::size_t at = outer.find(inner);
    std::string polyglot =
        raised(raised(inner, inner.size() - 6, at), inner.find("PK\x01\x02") + 42, at);
    polyglot.replace(inner.size() - 2, 2,
                     tests::little_endian(outer.size() - at - inner.size(), 2));
    const auto either = parse_npz(around(polyglot), "z");
    ASSERT_TRUE(either) << either.failure().message;
    EXPECT_EQ(either->values.size(), inner.size());
}

TEST(Npz, OtherCompressionMethodsOfPythonAreRefused) {
    const auto array = read_npz(kArchives + "bzip2.npz", "goal");
    ASSERT_FALSE(array);
    EXPECT_EQ(array.failure().message,
              "array 'goal': is packed by zip method 12, expected 0 (stored) or 8 (deflated)");
}

TEST(Npz, ABombThatAgreesWithItselfStopsWhereItsBytesDo) {
    // Header and directory both declare 400 MB, but 8 bytes of data are present.
    const std::string lie = npy("<f4", "(100000000,)", kTwo);
    const std::string header_only = lie.substr(0, lie.size() - kTwo.size());
    const std::string bytes =
        patched(zip_of({{"z.npy", lie, false}}), tests::little_endian(lie.size(), 4),
                tests::little_endian(header_only.size() + 400000000, 4));
    const auto array = parse_npz(bytes, "z");
    ASSERT_FALSE(array);
    EXPECT_EQ(array.failure().code, Code::malformed_archive) << array.failure().message;
}

TEST(Npz, CutAnywhere) {
    for (const bool deflated : {false, true}) {
        const std::string whole = archive(deflated);
        ASSERT_TRUE(parse_npz(whole, "z"));
        for (std::size_t n = 0; n < whole.size(); ++n) {
            const auto array = parse_npz(whole.substr(0, n), "z");
            ASSERT_FALSE(array) << n;
            EXPECT_FALSE(array.failure().message.empty()) << n;
        }
    }
}

TEST(Npz, AnyByteChangedIsSoundOrAnError) {
    const std::string whole = archive();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const int change : {0x01, 0x80, 0xff}) {
            std::string bytes = whole;
            bytes[i] = static_cast<char>(bytes[i] ^ change);
            const auto array = parse_npz(bytes, "z");
            // The checksum detects every other value.
            EXPECT_TRUE(!array || array->values == (std::vector<double>{1, 2})) << i;
        }
    }
}

TEST(Npz, FilesThatCannotBeRead) {
    const auto missing = read_npz("no_such.npz", "z");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.failure().code, Code::unreadable_data_file);
    EXPECT_EQ(missing.failure().message, "no such file");
}

}  // namespace
}  // namespace etlc::data
