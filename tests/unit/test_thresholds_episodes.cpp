// Tests the episodes in a thresholds file: many of them, read and written piece by piece, with the
// messages and places of files that are read whole.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "artifacts/file.hpp"
#include "artifacts/thresholds.hpp"
#include "data/files/hash.hpp"
#include "npy_bytes.hpp"

namespace etlc::thresholds {
namespace {

using diag::Code;

std::string with(const std::string& members) {
    const bool has_episodes = members.find("\"episodes\"") != std::string::npos;
    return R"({"format": 3, "spec": "s", "etlc": "1", "predicates": {}, "monitors": {}, )" +
           std::string(has_episodes ? "" : R"("episodes": [], )") + members + "}";
}

std::string message(const std::string& members) {
    const auto file = parse(with(members), "x");
    return file ? "none" : file.failure().message;
}

TEST(ThresholdsOfEpisodes, FaultsOfRecordings) {
    const std::string recording = R"("0123456789abcdef": {"z": "0123456789abcdef:00000001"})";
    EXPECT_EQ(message(R"("recordings": [])"), "'recordings' is an array, expected an object");
    EXPECT_EQ(message(R"("recordings": {"x": {}})"),
              "'recordings.x' is an object, expected an object named by a content hash of 16 hex "
              "digits");
    EXPECT_EQ(message(R"("recordings": {"0123456789abcdef": [{}], "x": 1})"),
              "'recordings.0123456789abcdef' is an array, expected an object named by a content "
              "hash of 16 hex digits");
    for (const std::string wrong :
         {"0123456789abcdef:0000000200000001", "0123456789abcdef", "0123456789abcdef:0000001",
          "0123456789abcdeg:00000001", "0123456789abcdef:00000001:",
          "0123456789abcdef:00000001:aparts", "0123456789abcdef:00000001:recurring",
          "0123456789abcdef:00000001:recurring:0000000200000001",
          "0123456789abcdef:00000001:recurring:00000001:apart"})
        EXPECT_EQ(
            message(fmt::format(R"("recordings": {{{}, "0000000000000001": {{"y": "{}"}}}})",
                                recording, wrong)),
            fmt::format(
                "'recordings.0000000000000001.y' is the text '{}', expected 16 hex "
                "digits, a colon, and ascending numbers of 8 hex digits; for an embedding then "
                "':apart', or ':recurring:' and such numbers",
                wrong));
    EXPECT_EQ(message("\"recordings\": {" + recording + "}"), "none");
}

TEST(ThresholdsOfEpisodes, ARecordingStandsOnce) {
    const std::string a = "\"000000000000000a\": {}";
    const std::string b = "\"000000000000000b\": {}";
    const auto said = [](const std::string& members) {
        return message("\"recordings\": {" + members + "}");
    };
    const auto twice = [](const std::string& key) {
        return fmt::format("key '{}' occurs twice in one object", key);
    };
    EXPECT_EQ(said(a + "," + b + "," + a), twice("000000000000000a"));
    EXPECT_EQ(said(a + "," + b + "," + b + "," + a), twice("000000000000000b"));  // the first
    EXPECT_EQ(said(R"("x": 1, )" + a + R"(, "x": 2)"), twice("x"));
    EXPECT_EQ(said(a + "," + a + R"(, "x": 1, "x": 2)"), twice("000000000000000a"));
    EXPECT_EQ(said(a + "," + a + ", ?"), twice("000000000000000a"));  // which comes before
    EXPECT_EQ(said(a + R"(, "000000000000000a" ?)"), twice("000000000000000a"));
    EXPECT_EQ(said(R"("000000000000000a": {"z": 1, "z": 2})"), twice("z"));
}

TEST(ThresholdsOfEpisodes, FaultsComeInTheOrderOfTheKeysNotOfTheFile) {
    const std::string episodes = R"("episodes": [1], )";
    EXPECT_EQ(message(episodes + R"("recordings": 1)"),
              "'episodes[0]' is '1', expected a content hash of 16 hex digits");
    EXPECT_EQ(message(R"("recordings": {"x": {}}, )" + episodes + R"("spek": 1)"),
              "unknown key 'spek'; did you mean 'spec'?");
    EXPECT_EQ(parse(R"({"recordings": {"x": {}}, "format": 4})", "x").failure().code,
              Code::unknown_thresholds_format);
    EXPECT_NE(message(R"("recordings": {"x": {}}, ?)").find("is not JSON"), std::string::npos);
}

TEST(ThresholdsOfEpisodes, PlacesBehindTheFirstPiece) {
    constexpr std::size_t kPiece = 1U << 16U;
    for (std::size_t blanks = kPiece - 12; blanks < kPiece + 4; ++blanks) {
        const std::string line = "{\n \"\xc3\xbc\": ";
        std::string json = line + std::string(blanks - line.size(), ' ');
        for (const auto& [wrong, what, width] :
             std::vector<std::tuple<std::string, std::string, std::uint32_t>>{
                 {"x", "'x'", 0},
                 {"\xc3\xbc", "'\xc3\xbc'", 0},
                 {"\xf0\x9f\x98\x80", "'\xf0\x9f\x98\x80'", 0},
                 {"1e999,", "number outside the range of a double", 4},
                 {"", "end", 0}}) {
            const auto file = parse(json + wrong, "x");
            ASSERT_FALSE(file);
            EXPECT_EQ(file.failure().message, "is not JSON: unexpected " + what) << blanks;
            EXPECT_EQ(file.failure().line, 2U);
            EXPECT_EQ(file.failure().column, blanks - 2 - 1 + 1 + width) << blanks << what;
        }
        const auto file = parse(json + "\n\n ?", "x");
        ASSERT_FALSE(file);
        EXPECT_EQ(file.failure().line, 4U);
        EXPECT_EQ(file.failure().column, 2U);
    }
}

/// So many that their text exceeds 64 MB.
File many_episodes() {
    File file;
    file.spec = "s";
    constexpr std::uint32_t kMany = 70'000;
    for (std::uint32_t e = 0; e < kMany; ++e) {
        data::Sketch sketch(120);
        for (std::uint32_t i = 0; i < sketch.size(); ++i) sketch[i] = e + 1000 * i;
        const std::uint64_t hash = (std::uint64_t{e} * 0x9e3779b97f4a7c15U) ^ e;
        file.episodes.push_back(hash);
        data::InputContent content{data::hash_text(hash), std::move(sketch)};
        content.samples = static_cast<data::Samples>(e % 3);
        if (content.samples == data::Samples::recurring) content.changes.resize(e % 2, e);
        file.recordings.add(hash, {{"z", std::move(content)}});
    }
    return file;
}

TEST(ThresholdsOfEpisodes, LargeFilesThatAreWrittenAreRead) {
    const File file = many_episodes();
    const tests::TemporaryPath path("x.thresholds.json", "");
    std::ofstream to(path.path());
    std::uint64_t bytes = 0;
    std::uint64_t longest = 0;
    ASSERT_TRUE(write(file, [&](std::string_view piece) {
        bytes += piece.size();
        longest = std::max<std::uint64_t>(longest, piece.size());
        return to.write(piece.data(), static_cast<std::streamsize>(piece.size())).good();
    }));
    to.close();
    EXPECT_GT(bytes, 64U << 20U);
    EXPECT_LT(longest, 1U << 17U);
    const auto again = read(path.path());
    ASSERT_TRUE(again) << again.failure().message;
    EXPECT_EQ(again->episodes, file.episodes);
    std::size_t recordings = 0;
    std::array<std::size_t, 3> of_kind{};
    std::size_t changes = 0;
    again->recordings.for_each([&](std::uint64_t hash, const data::EpisodeContent& content) {
        EXPECT_EQ(content.at("z").hash, data::hash_text(hash));
        EXPECT_EQ(content.at("z").sketch.size(), 120U);
        ++of_kind[static_cast<std::size_t>(content.at("z").samples)];
        changes += content.at("z").changes.size();
        ++recordings;
    });
    EXPECT_EQ(recordings, file.episodes.size());
    EXPECT_EQ(of_kind, (std::array<std::size_t, 3>{23'334, 23'333, 23'333}));
    EXPECT_EQ(changes, 11'666U);
}

TEST(ThresholdsOfEpisodes, WhatStaysInMemoryIsLimited) {
    const auto large = parse(std::string(artifacts::kMaxKeptBytes + (1U << 17U), ' '), "x");
    ASSERT_FALSE(large);
    EXPECT_EQ(large.failure().code, Code::unreadable_thresholds);
    EXPECT_EQ(large.failure().message,
              "is larger than 67108864 bytes without its recordings, the most that is read");
}

TEST(ThresholdsOfEpisodes, WritingEndsWhereNothingMoreIsTaken) {
    File file;
    file.episodes.resize(50'000);
    int pieces = 0;
    EXPECT_FALSE(write(file, [&](std::string_view) { return ++pieces < 2; }));
    EXPECT_EQ(pieces, 2);
}

}  // namespace
}  // namespace etlc::thresholds
