// Tests .npz traces: shapes, element types, Fortran order, lengths.
#include <gtest/gtest.h>

#include <cmath>

#include "data/traces/trace_formats.hpp"
#include "npy_bytes.hpp"
#include "recordings/open.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

using diag::Code;
using Kind = Channel::Kind;
using tests::floats;
using tests::npy;
using tests::TemporaryPath;
using tests::zip_of;

const std::string kTraces = ETLC_SOURCE_DIR "/tests/unit/data/";

TEST(NpzTrace, StepsOfEveryKind) {
    const std::vector<Channel> channels{
        {"z", Kind::vector, 3},       {"z_turned", Kind::vector, 3}, {"z_half", Kind::vector, 3},
        {"gripper", Kind::scalar, 1}, {"column", Kind::scalar, 1},   {"held", Kind::boolean, 1},
        {"gripper", Kind::vector, 1}, {"held_int", Kind::boolean, 1}};
    for (const char* file : {"trace_stored.npz", "trace_deflated.npz"}) {
        auto trace = open_trace(kTraces + file, channels);
        ASSERT_TRUE(trace) << trace.failure().message;
        EXPECT_EQ((*trace)->length(), 7U);
        Sample sample;
        for (int t = 0; t < 7; ++t) {
            const auto more = (*trace)->next(sample);
            ASSERT_TRUE(more) << more.failure().message;
            ASSERT_TRUE(*more);
            EXPECT_EQ(sample.present, std::vector<bool>(channels.size(), true));
            for (const int z : {0, 1, 2})
                EXPECT_EQ(sample.values[z], (std::vector<double>{t + 0.0, t + 0.25, t + 0.5})) << z;
            for (const int g : {3, 4, 6})
                EXPECT_EQ(sample.values[g], std::vector<double>{t / 8.0}) << g;
            for (const int b : {5, 7})
                EXPECT_EQ(sample.values[b], std::vector<double>{t % 2 + 0.0}) << b;
        }
        const auto more = (*trace)->next(sample);
        ASSERT_TRUE(more);
        EXPECT_FALSE(*more);
    }
}

TEST(NpzTrace, AnOptionalArrayMayBeAbsent) {
    auto trace = open_trace(kTraces + "trace_deflated.npz", {{"truth.at_a", Kind::boolean, 1, true},
                                                             {"gripper", Kind::scalar, 1},
                                                             {"held", Kind::boolean, 1, true}});
    ASSERT_TRUE(trace) << trace.failure().message;
    EXPECT_FALSE((*trace)->has(0));
    EXPECT_TRUE((*trace)->has(1));
    EXPECT_TRUE((*trace)->has(2));
    EXPECT_EQ((*trace)->length(), 7U);
    Sample sample;
    for (int t = 0; t < 7; ++t) {
        ASSERT_TRUE(*(*trace)->next(sample));
        EXPECT_EQ(sample.present, (std::vector<bool>{false, true, true}));
        EXPECT_TRUE(std::isnan(sample.values[0][0]));
        EXPECT_EQ(sample.values[2][0], t % 2);
    }
    const auto nothing =
        open_trace(kTraces + "trace_deflated.npz", {{"truth.at_a", Kind::boolean, 1, true}});
    ASSERT_FALSE(nothing);  // its number of steps is unknown
    EXPECT_EQ(nothing.failure().code, Code::trace_shape);
}

TEST(NpzTrace, NotFiniteIsNaN) {
    auto trace = open_trace(kTraces + "trace_deflated.npz", {{"gap", Kind::scalar, 1}});
    ASSERT_TRUE(trace);
    Sample sample;
    for (int t = 0; t < 7; ++t) {
        ASSERT_TRUE(*(*trace)->next(sample));
        EXPECT_EQ(std::isnan(sample.values[0][0]), t == 3);
    }
}

struct BrokenTrace {
    std::string what;
    std::vector<tests::Member> members;
    std::vector<Channel> channels;
    Code code;
    std::string message;
};

const std::vector<Channel> kScalar{{"g", Kind::scalar, 1}};
const std::vector<Channel> kVector{{"z", Kind::vector, 2}};
const std::vector<Channel> kBoolean{{"b", Kind::boolean, 1}};

std::vector<BrokenTrace> broken_traces() {
    const auto g = [](const std::string& descr, const std::string& shape, const std::string& data) {
        return std::vector<tests::Member>{{"g.npy", npy(descr, shape, data)}};
    };
    const auto z = [](const std::string& shape) {
        return std::vector<tests::Member>{{"z.npy", npy("<f4", shape, floats({1, 2, 3, 4}))}};
    };
    const std::string two = floats({1, 2});
    const std::string elements =
        ", expected little-endian float16, float32, float64, integers or bool";
    return {
        {"absent",
         {{"other.npy", npy("<f4", "(2,)", two)}},
         kScalar,
         Code::no_such_channel,
         "has no array 'g'; it holds 'other'"},
        {"absent, near",
         {{"gripper.npy", npy("<f4", "(2,)", two)}},
         {{"griper", Kind::scalar, 1}},
         Code::no_such_channel,
         "has no array 'griper'; it holds 'gripper'; did you mean 'gripper'?"},
        {"scalar with columns", g("<f4", "(1, 2)", two), kScalar, Code::trace_shape,
         "array 'g': has shape (1, 2), expected (steps,) or (steps, 1)"},
        {"no dimension", g("<f4", "()", floats({1})), kScalar, Code::trace_shape,
         "array 'g': has shape (), expected (steps,) or (steps, 1)"},
        {"vector without columns", z("(4,)"), kVector, Code::trace_shape,
         "array 'z': has shape (4,), expected (steps, 2)"},
        {"vector too wide", z("(1, 4)"), kVector, Code::trace_shape,
         "array 'z': has shape (1, 4), expected (steps, 2)"},
        {"three dimensions", z("(2, 2, 1)"), kVector, Code::trace_shape,
         "array 'z': has shape (2, 2, 1), expected (steps, 2)"},
        {"bool as a number", g("|b1", "(2,)", std::string("\0\1", 2)), kScalar,
         Code::trace_elements,
         "array 'g': has bool elements, expected numbers: the input is no bool"},
        {"big endian", g(">f4", "(2,)", two), kScalar, Code::trace_elements,
         "array 'g': has big-endian elements, '>f4'" + elements},
        {"cut short", g("<f4", "(3,)", two), kScalar, Code::malformed_trace_array,
         "array 'g': is cut short: float32 of shape (3,) takes 12 bytes, 8 are there"},
        {"left over", g("<f4", "(1,)", two), kScalar, Code::malformed_trace_array,
         "array 'g': has bytes left over: float32 of shape (1,) takes 4 bytes, 8 are there"},
        {"Fortran order cut short",
         {{"z.npy", npy("<f4", "(3, 2)", two, true)}},
         kVector,
         Code::malformed_trace_array,
         "array 'z': is cut short: float32 of shape (3, 2) takes 24 bytes, 8 are there"},
        {"no array",
         {{"g.npy", "hello, hello"}},
         kScalar,
         Code::malformed_trace_array,
         "array 'g': is no .npy array: begins with 'hello,', expected '\\x93NUMPY'"},
        {"lengths",
         {{"g.npy", npy("<f4", "(2,)", two)}, {"z.npy", npy("<f4", "(1, 2)", two)}},
         {kScalar[0], kVector[0]},
         Code::trace_shape,
         "arrays differ in length: 'g' has 2 steps, 'z' has 1"},
        {"no channels",
         {},
         {},
         Code::trace_shape,
         "the spec reads no input, so the arrays do not tell how many steps there are"},
        {"bool of 2",
         {{"b.npy", npy("<f4", "(2,)", floats({1, 2}))}},
         kBoolean,
         Code::trace_elements,
         "array 'b': holds 2 in step 1, expected 0 or 1"},
        {"bool byte of 2",
         {{"b.npy", npy("|b1", "(2,)", std::string("\1\2", 2))}},
         kBoolean,
         Code::malformed_trace_array,
         "array 'b': has the byte 2 as bool in step 1, expected 0 or 1"},
    };
}

/// Returns the first failure, on opening or on any step.
std::optional<diag::Failure> first_failure(const std::string& path,
                                           const std::vector<Channel>& channels) {
    auto trace = open_npz_trace(path, channels);
    if (!trace) return trace.failure();
    Sample sample;
    for (;;) {
        const auto more = (*trace)->next(sample);
        if (!more) return more.failure();
        if (!*more) return {};
    }
}

TEST(NpzTrace, EveryFaultHasItsMessage) {
    for (const BrokenTrace& one : broken_traces()) {
        const std::string bytes =
            zip_of(one.members.empty() ? std::vector<tests::Member>{{"x", "x"}} : one.members);
        const auto failure = first_failure(TemporaryPath("run.npz", bytes).path(), one.channels);
        ASSERT_TRUE(failure) << one.what;
        EXPECT_EQ(failure->code, one.code) << one.what;
        EXPECT_EQ(failure->message, one.message) << one.what;
    }
}

TEST(NpzTrace, NotAnArchive) {
    const auto failure = first_failure(TemporaryPath("run.npz", "no zip").path(), kScalar);
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->code, Code::malformed_trace_array);
    EXPECT_EQ(failure->message, "is no .npz file: not a zip archive");
}

TEST(NpzTrace, DamageIsFoundAtTheEndOfTheArray) {
    for (const bool fortran : {false, true}) {
        const std::string whole =
            zip_of({{"z.npy", npy("<f4", "(2, 2)", floats({1, 2, 3, 4}), fortran), false}});
        const std::string bytes = tests::patched(whole, floats({3, 4}), floats({3, 5}));
        const auto failure = first_failure(TemporaryPath("run.npz", bytes).path(), kVector);
        ASSERT_TRUE(failure) << fortran;
        EXPECT_EQ(failure->code, Code::malformed_trace_array);
        EXPECT_EQ(failure->message, "array 'z': archive is damaged: CRC error");
    }
}

TEST(NpzTrace, FortranOrderInBlocks) {
    // More than one block of 8 MiB: 3000 columns of doubles, 700 rows.
    constexpr std::uint64_t kRows = 700;
    constexpr std::uint32_t kColumns = 3000;
    std::string data(kRows * kColumns * 2, '\0');
    const auto element = [](std::uint64_t t, std::uint64_t d) {
        return (t * 7919 + d * 31) % 65536;
    };
    for (std::uint64_t d = 0; d < kColumns; ++d) {
        for (std::uint64_t t = 0; t < kRows; ++t) {
            const std::uint64_t at = 2 * (d * kRows + t);
            data[at] = static_cast<char>(element(t, d) & 0xff);
            data[at + 1] = static_cast<char>(element(t, d) >> 8);
        }
    }
    const std::string bytes = zip_of({{"z.npy", npy("<u2", "(700, 3000)", data, true)}});
    const TemporaryPath file("run.npz", bytes);
    auto trace = open_npz_trace(file.path(), {{"z", Kind::vector, kColumns}});
    ASSERT_TRUE(trace) << trace.failure().message;
    Sample sample;
    for (std::uint64_t t = 0; t < kRows; ++t) {
        ASSERT_TRUE(*(*trace)->next(sample));
        for (std::uint64_t d = 0; d < kColumns; ++d)
            ASSERT_EQ(sample.values[0][d], static_cast<double>(element(t, d))) << t << " " << d;
    }
    EXPECT_FALSE(*(*trace)->next(sample));
}

TEST(NpzTrace, WithoutATemporaryFolderFortranOrderSaysSo) {
    const std::string rows(std::size_t{2} << 20U, '\0');  // more than stays in memory
    const TemporaryPath file("run.npz", zip_of({{"z.npy", npy("<f4", "(262144, 2)", rows, true)}}));
    const std::string before = std::getenv("TMPDIR") != nullptr ? std::getenv("TMPDIR") : "";
    ::setenv("TMPDIR", "/no/such/folder", 1);
    const auto failure = first_failure(file.path(), kVector);
    before.empty() ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", before.c_str(), 1);
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->code, Code::unreadable_trace);
    EXPECT_EQ(failure->message,
              "array 'z': is in Fortran order, and a temporary file in /no/such/folder cannot be "
              "made: no such file; TMPDIR names another folder; in C order it needs none");
}

}  // namespace
}  // namespace etlc::recordings
