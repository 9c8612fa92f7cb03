// Tests the thresholds file: it reads back to the same bits, and every fault is reported with its
// key, the value found and the value expected.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "artifacts/file.hpp"
#include "artifacts/thresholds.hpp"
#include "npy_bytes.hpp"

namespace etlc::thresholds {
namespace {

using diag::Code;

const std::string kWhole = R"({
  "format": 3,
  "spec": "dubins",
  "predicates": {
    "at_a": {
      "method": "conformal",
      "alpha": 0.10,
      "epsilon": 0.30999997,
      "n": 3,
      "k": 2,
      "scores": [0.1, 0.2, "inf"],
      "reads": {
        "input z": "f32[2]",
        "target goal_a": "1 x 2, values #b08b72ea4df23cb1"
      }
    },
    "held": {
      "method": "f1",
      "epsilon": -5e-05,
      "n": 100,
      "k": 0,
      "scores": [],
      "reads": {}
    }
  },
  "monitors": {
    "reach": {
      "method": "class_conditional",
      "alpha": 5e-2,
      "epsilon": 1,
      "n": 1,
      "k": 1,
      "scores": [-0.5],
      "reads": {
        "monitor reach": "sliding, horizon 2"
      },
      "against": "missed_success",
      "episodes": [
        "00000000000000aa"
      ]
    }
  },
  "episodes": [
    "0000000000000001",
    "ffffffffffffffff"
  ],
  "recordings": {
    "0000000000000001": {
      "held": "00112233445566aa:",
      "z": "0123456789abcdef:0000000a00ff00ff"
    },
    "ffffffffffffffff": {}
  },
  "allowances": [
    { "reason": "few \"places\"", "overlapping": 2, "leaked": 0 },
    { "reason": "starts at home", "overlapping": 0, "leaked": 1 }
  ],
  "etlc": "0.1.0"
}
)";

TEST(Thresholds, ReadsWhatIsThere) {
    const auto file = parse(kWhole, "dubins.thresholds.json");
    ASSERT_TRUE(file) << file.failure().message;
    EXPECT_EQ(file->path, "dubins.thresholds.json");
    EXPECT_EQ(file->spec, "dubins");
    EXPECT_EQ(file->etlc, "0.1.0");
    EXPECT_EQ(file->episodes, (std::vector<std::uint64_t>{1, 0xffff'ffff'ffff'ffff}));
    ASSERT_EQ(file->predicates.size(), 2U);
    const Entry& at_a = file->predicates.at("at_a");
    EXPECT_EQ(at_a.method, "conformal");
    EXPECT_EQ(at_a.reads.at("input z"), "f32[2]");
    EXPECT_TRUE(file->predicates.at("held").reads.empty());
    EXPECT_EQ(file->monitors.at("reach").reads.size(), 1U);
    EXPECT_EQ(at_a.alpha, "0.10");
    EXPECT_EQ(at_a.epsilon, 0.31F - 0x1p-25F);
    EXPECT_EQ(at_a.n, 3U);
    EXPECT_EQ(at_a.k, 2U);
    EXPECT_EQ(at_a.scores, (std::vector<double>{0.1, 0.2, INFINITY}));
    EXPECT_EQ(file->predicates.at("held").alpha, "");
    EXPECT_EQ(file->predicates.at("held").epsilon, -5e-05F);
    EXPECT_EQ(file->monitors.at("reach").alpha, "5e-2");
    EXPECT_EQ(file->monitors.at("reach").against, "missed_success");
    EXPECT_EQ(all_episodes(*file), (std::vector<std::uint64_t>{1, 0xffff'ffff'ffff'ffff, 0xaa}));
}

TEST(Thresholds, WritingWhatWasReadChangesNothing) {
    const auto file = parse(kWhole, "x");
    ASSERT_TRUE(file);
    EXPECT_EQ(write(*file), kWhole);
}

TEST(Thresholds, SmallestFile) {
    const auto file = parse(
        R"({"etlc":"0.1.0","predicates":{},"monitors":{},"episodes":[],"spec":"s","format":3})",
        "x");
    ASSERT_TRUE(file) << file.failure().message;
    const std::string written = write(*file);
    const auto again = parse(written, "x");
    ASSERT_TRUE(again) << again.failure().message;
    EXPECT_EQ(write(*again), written);
}

TEST(Thresholds, NumbersReadBackToTheSameBits) {
    const float floats[] = {0.1F,        -0.0F,
                            0x1p-149F,   -0x1.fffffep-127F,
                            0x1p-126F,   std::numeric_limits<float>::max(),
                            16777217.0F, 1.0F / 3};
    const std::vector<double> doubles{
        0.1,      -0.0, 5e-324, std::numeric_limits<double>::max(), 1.0 / 3, 9007199254740993.0,
        -INFINITY};
    for (const float epsilon : floats) {
        Entry entry;
        entry.method = "conformal";
        entry.alpha = "0.3000000000000000000000000001";
        entry.epsilon = epsilon;
        entry.n = std::numeric_limits<std::uint64_t>::max();
        entry.k = 1;
        entry.scores = doubles;
        entry.reads["Z\xc3\xbcrich"] = "\"quotes\", \\ and \n";
        File file;
        file.predicates["p"] = entry;
        const auto read = parse(write(file), "x");
        ASSERT_TRUE(read) << read.failure().message;
        const Entry& again = read->predicates.at("p");
        EXPECT_EQ(std::bit_cast<std::uint32_t>(again.epsilon),
                  std::bit_cast<std::uint32_t>(epsilon));
        EXPECT_EQ(again.alpha, entry.alpha);
        EXPECT_EQ(again.n, entry.n);
        EXPECT_EQ(again.reads, entry.reads);
        ASSERT_EQ(again.scores.size(), doubles.size());
        for (std::size_t i = 0; i < doubles.size(); ++i)
            EXPECT_EQ(std::bit_cast<std::uint64_t>(again.scores[i]),
                      std::bit_cast<std::uint64_t>(doubles[i]))
                << i;
    }
}

const std::string kBoth = R"({
      "method": "conformal",
      "alpha": 0.1,
      "beta": 0.05,
      "epsilon": 0.5,
      "n": 1,
      "k": 1,
      "scores": [0.25],
      "inner": {
        "epsilon": "-inf",
        "n": 0,
        "k": 1,
        "scores": []
      },
      "reads": {},
      "against": "both",
      "within": 3
    })";

TEST(Thresholds, TwoThresholdsReadBack) {
    std::string json = kWhole;
    const std::size_t from = json.find("{", json.find("\"held\""));
    json.replace(from, json.find("\n    }", from) + 6 - from, kBoth);
    const auto file = parse(json, "x");
    ASSERT_TRUE(file) << file.failure().message;
    const Entry& held = file->predicates.at("held");
    EXPECT_EQ(held.beta, "0.05");
    EXPECT_EQ(held.against, "both");
    EXPECT_EQ(held.within, 3U);
    ASSERT_TRUE(held.inner);
    EXPECT_EQ(held.inner->epsilon, -INFINITY);
    EXPECT_EQ(held.inner->k, 1U);
    EXPECT_EQ(write(*file), json);

    const auto said = [&](const std::string& of, const std::string& to) {
        std::string other = json;
        other.replace(other.find(of, from), of.size(), to);
        const auto read = parse(other, "x");
        return read ? "" : read.failure().message;
    };
    EXPECT_EQ(said("\"-inf\"", "\"nan\""),
              "'predicates.held.inner.epsilon' is the text 'nan', expected a finite float32");
    EXPECT_EQ(
        said("\"against\": \"both\"", "\"against\": \"false_positives\""),
        "'predicates.held.against' is the text 'false_positives', expected 'both', since there "
        "is an inner threshold");
    EXPECT_EQ(said("0.05", "5"),
              "'predicates.held.beta' is '5', expected a number between 0 and 1");
    EXPECT_EQ(said("\"k\": 1,\n        \"scores\"", "\"k\": 2,\n        \"scores\""),
              "'predicates.held.inner.k' is '2', expected at most n + 1, which is 1");
}

TEST(Thresholds, LossesReadBack) {
    Entry entry;
    entry.method = "risk";
    entry.alpha = "0.1";
    entry.n = 2;
    entry.scores = {1};
    entry.losses = {0, 0.25};
    entry.losses_before = {0, 1};
    File file;
    file.predicates["p"] = entry;
    const auto read = parse(write(file), "x");
    ASSERT_TRUE(read) << read.failure().message;
    EXPECT_EQ(read->predicates.at("p").losses, entry.losses);
    EXPECT_EQ(read->predicates.at("p").losses_before, entry.losses_before);
    EXPECT_EQ(write(*read), write(file));
}

TEST(Thresholds, EveryFloatOfASampleReadsBack) {
    Entry entry;
    entry.method = "f1";
    File file;
    std::uint32_t bits = 1;
    for (int i = 0; i < 2000; ++i) {
        bits = bits * 1664525U + 1013904223U;
        const auto epsilon = std::bit_cast<float>(bits);
        if (!std::isfinite(epsilon)) continue;
        entry.epsilon = epsilon;
        file.predicates["p"] = entry;
        const auto read = parse(write(file), "x");
        ASSERT_TRUE(read) << read.failure().message;
        EXPECT_EQ(std::bit_cast<std::uint32_t>(read->predicates.at("p").epsilon), bits);
    }
}

struct Broken {
    std::string what;
    std::string json;
    Code code;
    std::string message;
    std::uint32_t line = 0;
    std::uint32_t column = 0;
};

/// Returns kWhole with one change.
std::string with(const std::string& from, const std::string& to) {
    std::string json = kWhole;
    const std::size_t at = json.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return json.replace(at, from.size(), to);
}

std::vector<Broken> syntax() {
    std::string deep(100'000, '[');
    const auto broken = [](const std::string& what, const std::string& json,
                           const std::string& message, std::uint32_t line, std::uint32_t column) {
        return Broken{what, json, Code::malformed_thresholds, message, line, column};
    };
    return {
        broken("empty", "", "is not JSON: unexpected end", 1, 1),
        broken("cut short", "{\n  \"format\": 1,\n", "is not JSON: unexpected end", 3, 1),
        broken("a word", "{\n  \"format\": one}", "is not JSON: unexpected 'o'", 2, 13),
        broken("after the end", "{} {}", "is not JSON: unexpected '{'", 1, 4),
        broken("NaN", with("0.30999997", "NaN"), "is not JSON: unexpected 'N'", 8, 18),
        broken("number overflow", with("0.30999997", "1e999"),
               "is not JSON: unexpected number outside the range of a double", 8, 22),
        broken("comma", "{\"a\": 1,}", "is not JSON: unexpected '}'", 1, 9),
        broken("UTF-8", "{\"\xff\": 1}", "is not JSON: unexpected '\\xff'", 1, 3),
        broken("column counts characters", "{\"\xc3\xbc\": x}", "is not JSON: unexpected 'x'", 1,
               7),
        broken("nesting bomb", deep, "nests deeper than 16 levels", 0, 0),
        broken("nesting bomb of objects", "{\"a\":" + deep, "nests deeper than 16 levels", 0, 0),
    };
}

std::vector<Broken> content() {
    const auto broken = [](const std::string& from, const std::string& to,
                           const std::string& message) {
        return Broken{from + " -> " + to, with(from, to), Code::invalid_thresholds, message, 0, 0};
    };
    const std::string at_a = "'predicates.at_a.";
    return {
        {"array", "[]", Code::invalid_thresholds, "the file is an array, expected an object"},
        {"nothing in it", "{}", Code::invalid_thresholds, "key 'format' is missing, expected 3"},
        {"format 2", with("\"format\": 3", "\"format\": 2"), Code::unknown_thresholds_format,
         "'format' is '2', expected 3, the format that this version reads"},
        {"format 4 with other keys", R"({"format": 4, "entries": []})",
         Code::unknown_thresholds_format,
         "'format' is '4', expected 3, the format that this version reads"},
        broken("\"format\": 3", "\"format\": \"3\"", "'format' is the text '3', expected 3"),
        broken("\"spec\": \"dubins\"", "\"spec\": null", "'spec' is null, expected a text"),
        broken("\"spec\"", "\"spek\"", "unknown key 'spek'; did you mean 'spec'?"),
        broken("\"etlc\"", "\"spec\"", "key 'spec' occurs twice in one object"),
        broken("  \"spec\": \"dubins\",\n", "", "key 'spec' is missing, expected a text"),
        broken("\"predicates\": {", "\"predicates\": true, \"episodes\": {",
               "key 'episodes' occurs twice in one object"),
        broken("\"held\": {", "\"held\": 1, \"other\": {",
               "'predicates.held' is '1', expected an object"),
        broken("\"method\": \"conformal\"", "\"method\": \"conform\"",
               at_a + "method' is the text 'conform', expected 'f1', 'conformal', "
                      "'class_conditional', 'adaptive', 'risk' or 'normal'"),
        broken("\"method\": \"conformal\",", "",
               "key " + at_a + "method' is missing, expected a text"),
        broken("\"alpha\": 0.10,", "",
               "key " + at_a + "alpha' is missing, expected a number between 0 and 1"),
        broken("0.10", "\"0.10\"",
               at_a + "alpha' is the text '0.10', expected a number between 0 and 1"),
        broken("0.10", "0.0", at_a + "alpha' is '0.0', expected a number between 0 and 1"),
        broken("0.10", "1", at_a + "alpha' is '1', expected a number between 0 and 1"),
        broken("0.10", "-0.1", at_a + "alpha' is '-0.1', expected a number between 0 and 1"),
        broken("\"method\": \"conformal\"", "\"method\": \"f1\"",
               at_a + "alpha' is '0.10', expected no such key for f1"),
        broken("0.30999997", "null", at_a + "epsilon' is null, expected a finite float32"),
        broken("0.30999997", "\"inf\"",
               at_a + "epsilon' is the text 'inf', expected a finite float32"),
        broken("0.30999997", "3.5e38", at_a + "epsilon' is '3.5e38', expected a finite float32"),
        broken("0.30999997", "-1e300", at_a + "epsilon' is '-1e300', expected a finite float32"),
        broken("0.30999997", "1e-60", at_a + "epsilon' is '1e-60', expected a finite float32"),
        broken("\"n\": 3", "\"n\": 3.5", at_a + "n' is '3.5', expected a whole number"),
        broken("\"n\": 3", "\"n\": -3", at_a + "n' is '-3', expected a whole number"),
        broken("\"n\": 3", "\"n\": 18446744073709551616",
               at_a + "n' is '18446744073709551616', expected a whole number"),
        broken("\"k\": 2", "\"k\": 0", at_a + "k' is '0', expected a rank from 1"),
        broken("\"k\": 2", "\"k\": 4", at_a + "k' is '4', expected at most n, which is 3"),
        broken("\"k\": 0", "\"k\": 1", "'predicates.held.k' is '1', expected 0 for f1"),
        broken("[0.1, 0.2, \"inf\"]", "0.1",
               at_a + "scores' is '0.1', expected an array of numbers"),
        broken("[0.1, 0.2, \"inf\"]", "[0.1, true]",
               at_a + "scores[1]' is true, expected a number, 'inf' or '-inf'"),
        broken("\"inf\"", "\"nan\"",
               at_a + "scores[2]' is the text 'nan', expected a number, 'inf' or '-inf'"),
        broken("\"missed_success\"", "\"error\"",
               "'monitors.reach.against' is the text 'error', expected 'missed_alarm', "
               "'missed_success' or 'both'"),
        broken("\"00000000000000aa\"", "1",
               "'monitors.reach.episodes[0]' is '1', expected a content hash of 16 hex digits"),
        broken("\"reads\": {}", "\"reads\": \"b08b72ea4df23cb1\"",
               "'predicates.held.reads' is the text 'b08b72ea4df23cb1', expected an object of "
               "texts"),
        broken("\"reads\": {}", "\"targets\": {}", "unknown key 'predicates.held.targets'"),
        broken("\"sliding, horizon 2\"", "[]",
               "'monitors.reach.reads.monitor reach' is an array, expected a text"),
        broken("\"0000000000000001\"", "1",
               "'episodes[0]' is '1', expected a content hash of 16 hex digits"),
        broken("\"ffffffffffffffff\"", "\"fffffffffffffffff\"",
               "'episodes[1]' is the text 'fffffffffffffffff', expected a content hash of 16 hex "
               "digits"),
        broken("\"monitors\": {", "\"monitors\": [], \"episodes\": {",
               "key 'episodes' occurs twice in one object"),
    };
}

TEST(Thresholds, EveryFaultHasItsMessage) {
    std::vector<Broken> all = syntax();
    for (const Broken& one : content()) all.push_back(one);
    for (const Broken& one : all) {
        const auto file = parse(one.json, "x");
        ASSERT_FALSE(file) << one.what;
        EXPECT_EQ(file.failure().code, one.code) << one.what;
        EXPECT_EQ(file.failure().message, one.message) << one.what;
        EXPECT_EQ(file.failure().line, one.line) << one.what;
        EXPECT_EQ(file.failure().column, one.column) << one.what;
    }
}

TEST(Thresholds, CutAnywhere) {
    // A missing line feed at the end is not an error.
    for (std::size_t n = 0; n + 1 < kWhole.size(); ++n)
        EXPECT_FALSE(parse(kWhole.substr(0, n), "x")) << n;
}

TEST(Thresholds, MoreValuesThanAreRead) {
    std::string json = "[0";
    for (std::uint64_t i = 0; i < artifacts::kMaxValues; ++i) json += ",0";
    const auto file = parse(json + "]", "x");
    ASSERT_FALSE(file);
    EXPECT_EQ(file.failure().code, Code::malformed_thresholds);
    EXPECT_EQ(file.failure().message, "holds more than 2097152 values, the most that are read");
}

TEST(Thresholds, TheExampleOfTheDocumentsIsSound) {
    const std::string page = tests::file_bytes(ETLC_SOURCE_DIR "/docs/calibration.md");
    const std::size_t begin = page.find("```json\n") + 8;
    const auto file = parse(page.substr(begin, page.find("```", begin) - begin), "x");
    ASSERT_TRUE(file) << file.failure().message;
    EXPECT_EQ(file->predicates.at("at_a").epsilon, 0.409F);
}

TEST(Thresholds, FromAFile) {
    const tests::TemporaryPath file("x.thresholds.json", kWhole);
    const auto read_back = read(file.path());
    ASSERT_TRUE(read_back) << read_back.failure().message;
    EXPECT_EQ(read_back->path, file.path());
    EXPECT_EQ(write(*read_back), kWhole);
    const auto missing = read(file.path() + "x");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.failure().code, Code::unreadable_thresholds);
    EXPECT_EQ(missing.failure().message, "no such file");
}

}  // namespace
}  // namespace etlc::thresholds
