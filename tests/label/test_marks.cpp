// Tests what the keys of `etlc label` do to the labels of a predicate.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "label/table.hpp"

namespace etlc::label {
namespace {

using episodes::Label;

constexpr std::uint64_t kSteps = 20;

/// Returns a character per step: "#" where it holds, "?" where nobody knows, "." elsewhere.
std::string drawn(const Marks& marks) {
    if (!marks) return "nobody";
    std::string text(kSteps, '.');
    for (const Interval& one : *marks)
        std::fill(text.begin() + static_cast<std::ptrdiff_t>(one.start),
                  text.begin() + static_cast<std::ptrdiff_t>(one.end),
                  one.label == Label::yes ? '#' : '?');
    return text;
}

struct Pressed {
    Key key;
    std::uint64_t step;
};

Marks after(const std::vector<Pressed>& keys) {
    Marks marks;
    for (const auto& [key, step] : keys) marks = after_key(marks, key, step, kSteps);
    return marks;
}

TEST(Marks, BeginAndEnd) {
    EXPECT_EQ(drawn(after({})), "nobody");
    EXPECT_EQ(drawn(after({{Key::begin, 5}})), ".....###############");
    EXPECT_EQ(drawn(after({{Key::begin, 5}, {Key::end, 8}})), ".....####...........");
    EXPECT_EQ(drawn(after({{Key::end, 3}})), "####................");
    EXPECT_EQ(drawn(after({{Key::begin, 5}, {Key::end, 8}, {Key::end, 11}})),
              ".....#######........");
    EXPECT_EQ(drawn(after({{Key::begin, 5}, {Key::end, 8}, {Key::begin, 7}})),
              ".......##...........");
}

TEST(Marks, AnEarlierIntervalKeepsTheLaterOne) {
    const std::vector<Pressed> later{{Key::begin, 12}, {Key::end, 15}};
    std::vector<Pressed> keys = later;
    keys.push_back({Key::begin, 3});
    EXPECT_EQ(drawn(after(keys)), "...#############....");
    EXPECT_EQ(joined(*after(keys)), (std::vector<Interval>{{3, 16}}));
    keys.push_back({Key::end, 6});
    EXPECT_EQ(drawn(after(keys)), "...####.....####....");
}

TEST(Marks, OtherKeys) {
    const std::vector<Pressed> one{{Key::begin, 5}, {Key::end, 8}};
    const auto then = [&](Key key, std::uint64_t step) {
        std::vector<Pressed> keys = one;
        keys.push_back({key, step});
        return drawn(after(keys));
    };
    EXPECT_EQ(then(Key::unknown, 6), ".....????...........");
    EXPECT_EQ(then(Key::unknown, 9), ".....####...........");
    EXPECT_EQ(then(Key::remove, 8), "....................");
    EXPECT_EQ(then(Key::remove, 4), ".....####...........");
    EXPECT_EQ(then(Key::never, 0), "....................");
    EXPECT_EQ(then(Key::forget, 0), "nobody");
    EXPECT_EQ(drawn(after({{Key::remove, 0}})), "nobody");
}

TEST(Marks, NoOrderOfKeysBreaksThem) {
    std::mt19937 random(7);
    for (int run = 0; run < 2000; ++run) {
        Marks marks;
        for (int press = 0; press < 12; ++press) {
            const auto key = static_cast<Key>(random() % 6);
            marks = after_key(marks, key, random() % kSteps, kSteps);
            std::uint64_t last = 0;
            for (const Interval& one : marks.value_or(std::vector<Interval>())) {
                ASSERT_LE(last, one.start);
                ASSERT_LT(one.start, one.end);
                ASSERT_LE(one.end, kSteps);
                last = one.end;
            }
        }
    }
}

TEST(Marks, KeysHaveNames) {
    EXPECT_EQ(key_named("begin"), Key::begin);
    EXPECT_EQ(key_named("forget"), Key::forget);
    EXPECT_FALSE(key_named("undo"));
}

}  // namespace
}  // namespace etlc::label
