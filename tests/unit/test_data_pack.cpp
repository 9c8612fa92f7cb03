// Packed results of an episode read back as written, and invalid bytes are refused.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "data/spill/spill.hpp"

namespace etlc::data {
namespace {

enum class Mode : std::uint8_t { plain, adaptive };

struct Result {
    std::string name;
    std::vector<float> values;
    std::map<std::string, std::optional<double>> bounds;
    bool alarm = false;
    Mode kind = Mode::plain;

    friend bool operator==(const Result&, const Result&) = default;
};

template <class Archive>
void fields(Archive& archive, Result& result) {
    archive(result.name, result.values, result.bounds, result.alarm, result.kind);
}

Result example() {
    return {.name = "drive 7",
            .values = {-0.0F, 1.5F, std::numeric_limits<float>::infinity()},
            .bounds = {{"", std::nullopt}, {"near", 0.25}, {"far", -4.0}},
            .alarm = true,
            .kind = Mode::adaptive};
}

TEST(Pack, ReadsWhatItWrote) {
    const auto again = unpacked<Result>(packed(example()));
    ASSERT_TRUE(again);
    EXPECT_EQ(*again, example());
}

// For every byte, each other value either gives another result or is refused. A fuzzer found a bool
// of 2 that was read as true, and written again as 1.
TEST(Pack, WritesWhatItReadAgain) {
    const std::string bytes = packed(example());
    int refused = 0;
    for (std::size_t place = 0; place < bytes.size(); ++place) {
        for (int value = 0; value < 256; ++value) {
            std::string changed = bytes;
            changed[place] = static_cast<char>(value);
            const auto read = unpacked<Result>(changed);
            refused += !read;
            if (read) {
                ASSERT_EQ(packed(*read), changed) << "byte " << place << " as " << value;
            }
        }
    }
    EXPECT_GT(refused, 0);
}

TEST(Pack, RefusesFlagsThatAreNeitherOneNorZero) {
    EXPECT_TRUE(unpacked<bool>(packed(std::uint64_t{1})));
    EXPECT_FALSE(unpacked<bool>(packed(std::uint64_t{2})));
    EXPECT_FALSE(unpacked<std::optional<double>>(packed(std::uint64_t{2}) + packed(0.5)));
}

TEST(Pack, RefusesNumbersThatAreTooWide) {
    EXPECT_FALSE(unpacked<float>(packed(std::uint64_t{1} << 32U)));
    EXPECT_FALSE(unpacked<Mode>(packed(std::uint64_t{256})));
}

TEST(Pack, RefusesKeysThatAreOutOfOrderOrTwice) {
    const auto two = [](std::uint64_t first, std::uint64_t second) {
        return packed(std::uint64_t{2}) + packed(first) + packed(0.5) + packed(second) +
               packed(0.5);
    };
    using Map = std::map<std::uint64_t, double>;
    EXPECT_TRUE(unpacked<Map>(two(1, 2)));
    EXPECT_FALSE(unpacked<Map>(two(2, 1)));
    EXPECT_FALSE(unpacked<Map>(two(1, 1)));
}

TEST(Pack, RefusesBytesThatAreMissingOrTooMany) {
    const std::string bytes = packed(example());
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_FALSE(unpacked<Result>(std::string_view(bytes).substr(0, size))) << size;
    EXPECT_FALSE(unpacked<Result>(bytes + '\0'));
}

}  // namespace
}  // namespace etlc::data
