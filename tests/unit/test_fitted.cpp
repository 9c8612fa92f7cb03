// Tests the file of fits: it reads back to the same bits, numpy can read it, and every fault is
// reported with its key, the value found and the value expected.
#include "artifacts/fitted.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>

#include "data/arrays/archive.hpp"
#include "data/arrays/array.hpp"
#include "npy_bytes.hpp"

namespace etlc::fitted {
namespace {

diag::Result<File> parse(const std::string& bytes) {
    return read(tests::TemporaryPath("x.fitted.npz", bytes).path());
}

using diag::Code;

const std::string kDescription = R"text({
  "format": 3,
  "spec": "dock",
  "entries": {
    "Q": {
      "declaration": "fitted(pca, of = z, where = true, r = 1)",
      "reads": {
        "input z": "f32[3]",
        "where": "true"
      },
      "array": "Q",
      "offset": "Q-offset",
      "frames": 900
    },
    "anchors": {
      "declaration": "fitted(medoids, of = z, where = near, k = 2)",
      "reads": {},
      "array": "anchors",
      "frames": 300,
      "medoids": [
        { "episode": "0123456789abcdef", "step": 12 },
        { "episode": "0123456789abcdef", "step": 80 }
      ]
    },
    "fitted(discriminant, of = z, where = near)": {
      "declaration": "fitted(discriminant, of = z, where = near)",
      "reads": {},
      "array": "metric-1",
      "frames": 300
    }
  },
  "episodes": [
    "0123456789abcdef"
  ],
  "recordings": {
    "0123456789abcdef": {
      "z": "fedcba9876543210:0000000100000002"
    }
  },
  "allowances": [
    { "reason": "two cameras", "overlapping": 2, "leaked": 0 }
  ],
  "etlc": "0.1.0"
}
)text";

std::string archive(const std::string& description) {
    return data::npz_bytes(
        {{"fitted.json", description},
         {"Q.npy", data::npy_bytes({1, 3}, {1, 0.1F, -0.0F})},
         {"Q-offset.npy", data::npy_bytes({3}, {0, 1, 1e-45F})},
         {"anchors.npy", data::npy_bytes({2, 3}, {1, 2, 3, 4, 5, 6})},
         {"metric-1.npy", data::npy_bytes({1, 1}, {2})},
         {"infinite.npy", data::npy_bytes({1, 2}, {0, std::numeric_limits<float>::infinity()})}});
}

File whole() {
    const auto file = parse(archive(kDescription));
    EXPECT_TRUE(file) << file.failure().message;
    return *file;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.rfind(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

/// Replaces `from` by `to` in the description.
diag::Failure failure_of(const std::string& from, const std::string& to) {
    const auto file = parse(archive(replaced(kDescription, from, to)));
    EXPECT_FALSE(file) << to;
    return file ? diag::Failure{} : file.failure();
}

TEST(Fitted, ReadsArraysAndWhereTheyComeFrom) {
    const File file = whole();
    EXPECT_EQ(file.spec, "dock");
    ASSERT_EQ(file.entries.size(), 3U);
    const Entry& q = file.entries.at("Q");
    EXPECT_EQ(q.reads.at("where"), "true");
    EXPECT_EQ(q.rows, 1U);
    EXPECT_EQ(q.columns, 3U);
    EXPECT_EQ(q.matrix, (std::vector<float>{1, 0.1F, -0.0F}));
    EXPECT_EQ(q.offset, (std::vector<float>{0, 1, 1e-45F}));
    EXPECT_EQ(q.frames, 900U);
    const Entry& anchors = file.entries.at("anchors");
    EXPECT_EQ(anchors.hash, data::content_hash({2, 3}, {1, 2, 3, 4, 5, 6}));
    ASSERT_EQ(anchors.medoids.size(), 2U);
    EXPECT_EQ(anchors.medoids[1].step, 80U);
    std::size_t recordings = 0;
    file.recordings.for_each([&](std::uint64_t hash, const data::EpisodeContent& content) {
        EXPECT_EQ(hash, 0x0123456789abcdefU);
        EXPECT_EQ(content.at("z").sketch.size(), 2U);
        ++recordings;
    });
    EXPECT_EQ(recordings, 1U);
    ASSERT_EQ(file.allowances.size(), 1U);
    EXPECT_EQ(file.allowances[0].reason, "two cameras");
}

TEST(Fitted, WritesTheSameDescriptionAndTheSameBytes) {
    const std::string written = write(whole());
    EXPECT_EQ(written, write(*parse(written)));
    EXPECT_NE(written.find(kDescription), std::string::npos) << "members are stored as they are";
}

TEST(Fitted, AnOffsetIsPartOfTheHash) {
    Entry entry = whole().entries.at("Q");
    const std::string before = content_hash(entry);
    entry.offset[0] = 1;
    EXPECT_NE(content_hash(entry), before);
}

TEST(Fitted, FaultsNameTheKeyWhatIsThereAndWhatIsExpected) {
    struct Case {
        std::string from, to, message;
    };
    const std::vector<Case> cases = {
        {R"("frames": 900)", R"("frames": -1)",
         "'entries.Q.frames' is '-1', expected a whole number"},
        {R"("array": "Q")", R"("arrays": "Q")",
         "unknown key 'entries.Q.arrays'; did you mean 'array'?"},
        {R"("array": "anchors")", R"("array": "Q-offset")",
         "array 'Q-offset' has shape (3,), expected rows x dimension"},
        {R"("offset": "Q-offset")", R"("offset": "anchors")",
         "array 'anchors' has shape (2, 3), expected dimension"},
        {R"("array": "Q")", R"("array": "metric-1")",
         "array 'Q-offset' has 3 numbers, expected 1, one per column of its matrix"},
        {R"("array": "metric-1")", R"("array": "infinite")",
         "array 'infinite' holds inf at element 1, expected finite numbers"},
        {R"("anchors": {)", R"("a b": {)",
         "'entries.a b' is neither the name of a projection or target nor the declaration of a "
         "metric"},
        {R"("step": 12 },)", R"("step": 12 }, {},)",
         "'entries.anchors.medoids' is an array, expected one of 2 frames, one per row"},
        {R"("0123456789abcdef", "step": 80)", R"("0123", "step": 80)",
         "'entries.anchors.medoids[1].episode' is the text '0123', expected a content hash of 16 "
         "hex digits"},
    };
    for (const Case& one : cases) {
        const auto failure = failure_of(one.from, one.to);
        EXPECT_EQ(failure.message, one.message);
        EXPECT_EQ(failure.code, Code::invalid_fitted);
    }
    EXPECT_EQ(failure_of(R"("format": 3)", R"("format": 2)").code, Code::unknown_fitted_format);
    EXPECT_EQ(failure_of("}\n", "").code, Code::malformed_fitted);
    EXPECT_EQ(failure_of(R"("array": "anchors")", R"("array": "anchor")").message,
              "has no array 'anchor'; it holds 'Q', 'Q-offset', 'anchors', 'metric-1' and "
              "'infinite'; did you mean 'anchors'?");
}

TEST(Fitted, OtherArchivesSayWhatIsExpected) {
    const auto other = parse(data::npz_bytes({{"z.npy", data::npy_bytes({1}, {1})}}));
    ASSERT_FALSE(other);
    EXPECT_EQ(other.failure().code, Code::malformed_fitted);
    EXPECT_EQ(other.failure().message,
              "has no member 'fitted.json', expected a file that 'etlc fit' wrote");
    std::string damaged = archive(kDescription);
    damaged[damaged.find("anchors")] = 'b';
    const auto read = parse(damaged);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.failure().code, Code::malformed_archive);
}

TEST(Fitted, LiesBesideTheSpec) {
    EXPECT_EQ(default_path("specs/dock.etl"), "specs/dock.fitted.npz");
}

}  // namespace
}  // namespace etlc::fitted
