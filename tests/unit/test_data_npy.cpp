// Tests .npy files: files of numpy are read exactly, and everything else gets its message.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "data/arrays/array.hpp"
#include "npy_bytes.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using tests::floats;
using tests::npy;
using tests::npy_dictionary;
using tests::npy_raw;
using tests::parse_npy;

const std::string kFolder = ETLC_SOURCE_DIR "/tests/unit/data/";

struct SoundArray {
    std::string file;
    Element element;
    double offset;  ///< element (i, j) is (4 i + j + offset) * scale
    double scale;
};

class SoundNpy : public ::testing::TestWithParam<SoundArray> {};

TEST_P(SoundNpy, ReadsAsNumpyWroteIt) {
    const auto array = read_npy(kFolder + GetParam().file + ".npy");
    ASSERT_TRUE(array) << array.failure().message;
    EXPECT_EQ(array->shape, (std::vector<std::uint64_t>{3, 4}));
    EXPECT_EQ(array->shape_text(), "(3, 4)");
    EXPECT_EQ(array->element, GetParam().element);
    ASSERT_EQ(array->values.size(), 12U);
    for (int k = 0; k < 12; ++k)
        EXPECT_EQ(array->values[k], (k + GetParam().offset) * GetParam().scale) << k;
}

INSTANTIATE_TEST_SUITE_P(
    Npy, SoundNpy,
    ::testing::Values(
        SoundArray{"f2_c", Element::f16, -2, 0.5}, SoundArray{"f2_fortran", Element::f16, -2, 0.5},
        SoundArray{"f4_c", Element::f32, -2, 0.5}, SoundArray{"f4_fortran", Element::f32, -2, 0.5},
        SoundArray{"f8_c", Element::f64, -2, 0.5}, SoundArray{"f8_fortran", Element::f64, -2, 0.5},
        SoundArray{"i1", Element::i8, -2, 1}, SoundArray{"i2", Element::i16, -2, 1},
        SoundArray{"i4", Element::i32, -2, 1}, SoundArray{"i8", Element::i64, -2, 1},
        SoundArray{"u1", Element::u8, 0, 1}, SoundArray{"u2", Element::u16, 0, 1},
        SoundArray{"u4", Element::u32, 0, 1}, SoundArray{"u8", Element::u64, 0, 1},
        SoundArray{"version2", Element::f32, -2, 0.5},
        SoundArray{"version3", Element::f32, -2, 0.5}),
    [](const auto& one) { return one.param.file; });

TEST(Npy, BoolReadsAsZeroAndOne) {
    const auto array = read_npy(kFolder + "bool.npy");
    ASSERT_TRUE(array) << array.failure().message;
    EXPECT_EQ(array->element, Element::boolean);
    for (int k = 0; k < 12; ++k) EXPECT_EQ(array->values[k], k % 2);
}

TEST(Npy, AnyRank) {
    const auto scalar = read_npy(kFolder + "scalar.npy");
    ASSERT_TRUE(scalar);
    EXPECT_EQ(scalar->shape_text(), "()");
    EXPECT_EQ(scalar->values, std::vector<double>{2.5});
    const auto vector = read_npy(kFolder + "vector.npy");
    ASSERT_TRUE(vector);
    EXPECT_EQ(vector->shape_text(), "(3,)");
    EXPECT_EQ(vector->values, (std::vector<double>{1, 2.5, -3}));
    const auto empty = read_npy(kFolder + "empty.npy");
    ASSERT_TRUE(empty);
    EXPECT_EQ(empty->shape_text(), "(0, 4)");
    EXPECT_TRUE(empty->values.empty());
    const auto turned = read_npy(kFolder + "rank3_fortran.npy");
    ASSERT_TRUE(turned);
    for (int k = 0; k < 24; ++k) EXPECT_EQ(turned->values[k], k);
}

TEST(Npy, SpecialValuesStay) {
    const auto array = read_npy(kFolder + "special.npy");
    ASSERT_TRUE(array);
    const auto& v = array->values;
    EXPECT_TRUE(std::isnan(v[0]));
    EXPECT_EQ(v[1], INFINITY);
    EXPECT_EQ(v[2], -INFINITY);
    EXPECT_TRUE(v[3] == 0 && std::signbit(v[3]));
    EXPECT_EQ(v[4], std::ldexp(1, -24));
    EXPECT_EQ(v[5], 65504);
}

/// Converts binary16 to binary32 by moving bits, as an alternative implementation.
float half_by_bits(std::uint32_t half) {
    const std::uint32_t sign = (half & 0x8000U) << 16U;
    const std::uint32_t exponent = (half >> 10U) & 0x1fU;
    const std::uint32_t mantissa = half & 0x3ffU;
    if (exponent == 0x1f) return std::bit_cast<float>(sign | 0x7f800000U | (mantissa << 13U));
    if (exponent != 0)
        return std::bit_cast<float>(sign | ((exponent + 112U) << 23U) | (mantissa << 13U));
    const float magnitude =
        std::bit_cast<float>(0x3f000000U | mantissa) - 0.5F;  // 0.5 has an ulp of 2^-24
    return sign != 0 ? -magnitude : magnitude;
}

TEST(Npy, EveryFloat16IsExact) {
    for (std::uint32_t bits = 0; bits < 0x10000U; ++bits) {
        const double ours = half_to_double(static_cast<std::uint16_t>(bits));
        const double theirs = half_by_bits(bits);
        if (std::isnan(theirs))
            EXPECT_TRUE(std::isnan(ours)) << bits;
        else
            ASSERT_EQ(std::bit_cast<std::uint64_t>(ours), std::bit_cast<std::uint64_t>(theirs))
                << bits;
    }
}

TEST(Npy, IntegersAtTheEndsOfTheirTypes) {
    const auto low =
        parse_npy(npy("<i8", "(2,)", std::string(7, '\0') + "\x80" + std::string(8, '\xff')));
    ASSERT_TRUE(low) << low.failure().message;
    EXPECT_EQ(low->values, (std::vector<double>{-9223372036854775808.0, -1}));
    const auto high = parse_npy(npy("<u4", "(1,)", "\xff\xff\xff\xff"));
    ASSERT_TRUE(high);
    EXPECT_EQ(high->values, std::vector<double>{4294967295.0});
    const auto byte = parse_npy(npy("|i1", "(1,)", "\x80"));
    ASSERT_TRUE(byte);
    EXPECT_EQ(byte->values, std::vector<double>{-128});
}

TEST(Npy, HeaderMayBeWrittenOtherwise) {
    const std::string data = floats({1, 2});
    for (const char* dictionary :
         {"{'shape':(2L,),'fortran_order':False,'descr':\"<f4\"}",
          "{ 'descr' : '<f4' , 'fortran_order' : True,\n'shape' : (2,)}"}) {
        const auto array = parse_npy(npy_raw(dictionary, data));
        ASSERT_TRUE(array) << array.failure().message;
        EXPECT_EQ(array->values, (std::vector<double>{1, 2}));
    }
}

struct BrokenArray {
    std::string what;
    std::string bytes;
    Code code;
    std::string message;
};

const std::string kExpectedElements =
    ", expected little-endian float16, float32, float64, integers or bool";

std::vector<BrokenArray> broken_arrays() {
    const std::string two = floats({1, 2});
    const auto header = [&](const std::string& dictionary) { return npy_raw(dictionary, two); };
    const auto elements = [&](const std::string& descr) { return npy(descr, "(2,)", two); };
    const auto shape = [&](const std::string& text) { return npy("<f4", text, two); };
    std::string version = shape("(2,)");
    version[6] = 4;
    std::string minor = shape("(2,)");
    minor[7] = 1;
    std::string long_header = npy_raw(npy_dictionary("<f4", false, "(2,)"), two, 2);
    long_header.replace(8, 4, "\xff\xff\xff\xff");
    std::string ones = "(";
    for (int i = 0; i < 33; ++i) ones += "1,";
    return {
        {"empty", "", Code::malformed_array, "ends within the magic word: 0 bytes of 8"},
        {"other file", "step,z[0],z[1]\n", Code::malformed_array,
         "is no .npy array: begins with 'step,z', expected '\\x93NUMPY'"},
        {"version", version, Code::malformed_array,
         "has .npy version 4.0, expected 1.0, 2.0 or 3.0"},
        {"minor version", minor, Code::malformed_array,
         "has .npy version 1.1, expected 1.0, 2.0 or 3.0"},
        {"header length", long_header, Code::malformed_array,
         "has a header of 4294967295 bytes, at most 65536 are read"},
        {"not a dictionary", header("[1, 2]"), Code::malformed_array,
         "header has '[', expected '{'"},
        {"no dictionary", header(""), Code::malformed_array, "header has its end, expected '{'"},
        {"open dictionary", header("{'descr': '<f4', "), Code::malformed_array,
         "header has its end, expected a text in quotes"},
        {"open text", header("{'descr"), Code::malformed_array,
         "header has a text without its closing quote"},
        {"key", header("{'dtype': '<f4'}"), Code::malformed_array,
         "header has the key 'dtype', expected 'descr', 'fortran_order' and 'shape'"},
        {"key twice", header("{'descr': '<f4', 'descr': '<f4'}"), Code::malformed_array,
         "header has the key 'descr' twice"},
        {"key missing", header("{'descr': '<f4', 'shape': (2,)}"), Code::malformed_array,
         "header has no key 'fortran_order'"},
        {"no colon", header("{'descr' '<f4'}"), Code::malformed_array,
         "header has ''', expected ':'"},
        {"no comma", header("{'descr': '<f4' 'shape': (2,)}"), Code::malformed_array,
         "header has ''', expected ','"},
        {"after the end", header("{'descr': '<f4', 'fortran_order': False, 'shape': (2,)} 1"),
         Code::malformed_array, "header goes on after its '}': '1"},
        {"order", header("{'fortran_order': 0}"), Code::malformed_array,
         "header's 'fortran_order' is '0}"},
        {"dimension", shape("(-2,)"), Code::malformed_array, "header's 'shape' holds '-2,), }"},
        {"no tuple", shape("2"), Code::malformed_array, "header has '2', expected '('"},
        {"no tuple of one", shape("(2)"), Code::malformed_array, "header has ')', expected ','"},
        {"rank", shape(ones + ")"), Code::malformed_array, "has more than 32 dimensions"},
        {"big endian", elements(">f4"), Code::unsupported_elements,
         "has big-endian elements, '>f4'" + kExpectedElements},
        {"native order", elements("=f4"), Code::unsupported_elements,
         "has elements of type '=f4'" + kExpectedElements},
        {"records", header("{'descr': [('x', '<f4')], "), Code::unsupported_elements,
         "has structured elements (records)" + kExpectedElements},
        {"objects", elements("|O"), Code::unsupported_elements,
         "has elements of type '|O' (Python objects)" + kExpectedElements},
        {"complex", elements("<c8"), Code::unsupported_elements,
         "has elements of type '<c8' (complex numbers)" + kExpectedElements},
        {"text", elements("<U4"), Code::unsupported_elements,
         "has elements of type '<U4' (text)" + kExpectedElements},
        {"time", elements("<M8[s]"), Code::unsupported_elements,
         "has elements of type '<M8[s]' (times)" + kExpectedElements},
        {"raw", elements("|V8"), Code::unsupported_elements,
         "has elements of type '|V8' (raw bytes)" + kExpectedElements},
        {"long double", elements("<f16"), Code::unsupported_elements,
         "has elements of type '<f16'" + kExpectedElements},
        {"no type", elements(""), Code::unsupported_elements,
         "has elements of type ''" + kExpectedElements},
        {"one dimension too large", shape("(9223372036854775808,)"), Code::array_too_large,
         "has a dimension above 2^63 - 1"},
        {"dimension of many digits", shape("(99999999999999999999999,)"), Code::array_too_large,
         "has a dimension above 2^63 - 1"},
        {"product overflows", shape("(4294967296, 4294967296)"), Code::array_too_large,
         "shape (4294967296, 4294967296) has more elements than can be counted"},
        {"product wraps to 2", shape("(9223372036854775807, 2, 9223372036854775807)"),
         Code::array_too_large,
         "shape (9223372036854775807, 2, 9223372036854775807) has more elements than can be "
         "counted"},
        {"bytes overflow", shape("(4611686018427387904,)"), Code::array_too_large,
         "shape (4611686018427387904,) has more elements than can be counted"},
        {"huge", shape("(1000000000, 32)"), Code::wrong_array_size,
         "is cut short: float32 of shape (1000000000, 32) takes 128000000000 bytes, 8 are there"},
        {"cut short", npy("<f4", "(3,)", two), Code::wrong_array_size,
         "is cut short: float32 of shape (3,) takes 12 bytes, 8 are there"},
        {"left over", npy("<f4", "(3, 0)", two), Code::wrong_array_size,
         "has bytes left over: float32 of shape (3, 0) takes 0 bytes, 8 are there"},
        {"bool of 2", npy("|b1", "(3,)", std::string("\x01\x00\x02", 3)), Code::malformed_array,
         "has the byte 2 as bool element 2, expected 0 or 1"},
    };
}

TEST(Npy, EveryFaultHasItsMessage) {
    for (const BrokenArray& one : broken_arrays()) {
        const auto array = parse_npy(one.bytes);
        ASSERT_FALSE(array) << one.what;
        EXPECT_EQ(array.failure().code, one.code) << one.what;
        const std::string message = array.failure().message;
        // A quotation of a header may extend into its padding.
        const bool open_end = one.message.ends_with("}") || one.message.ends_with("'1");
        const std::string& expected = one.message;
        EXPECT_EQ(open_end ? message.substr(0, expected.size()) : message, expected) << one.what;
    }
}

TEST(Npy, CutAnywhere) {
    for (const int major : {1, 2, 3}) {
        const std::string whole =
            npy_raw(npy_dictionary("<f4", false, "(2, 2)"), floats({1, 2, 3, 4}), major);
        ASSERT_TRUE(parse_npy(whole));
        for (std::size_t n = 0; n < whole.size(); ++n) {
            const auto array = parse_npy(whole.substr(0, n));
            ASSERT_FALSE(array) << n;
            EXPECT_EQ(array.failure().code,
                      n + 16 < whole.size() ? Code::malformed_array : Code::wrong_array_size)
                << n;
        }
        const auto longer = parse_npy(whole + "x");
        ASSERT_FALSE(longer);
        EXPECT_EQ(longer.failure().message,
                  "has bytes left over: float32 of shape (2, 2) takes 16 bytes, 17 are there");
    }
}

TEST(Npy, NumpysOtherTypesAreRefused) {
    for (const char* file : {"big_endian", "structured", "object", "complex", "text", "time"}) {
        const auto array = read_npy(kFolder + file + ".npy");
        ASSERT_FALSE(array) << file;
        EXPECT_EQ(array.failure().code, Code::unsupported_elements) << array.failure().message;
    }
}

TEST(Npy, MoreElementsThanAreRead) {
    const std::uint64_t n = kMaxArrayElements + 1;
    const tests::TemporaryPath file("large.npy", npy("|i1", fmt::format("({},)", n), ""));
    ASSERT_EQ(::truncate(file.path().c_str(),
                         static_cast<off_t>(tests::file_bytes(file.path()).size() + n)),
              0);  // sparse
    const auto array = read_npy(file.path());
    ASSERT_FALSE(array);
    EXPECT_EQ(array.failure().code, Code::array_too_large);
    EXPECT_EQ(array.failure().message,
              "shape (134217729,) has 134217729 elements, at most 134217728 are read");
}

TEST(Npy, FilesThatCannotBeRead) {
    const auto missing = read_array(kFolder + "no_such.npy", "");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.failure().code, Code::unreadable_data_file);
    EXPECT_EQ(missing.failure().message, "no such file");
    const tests::TemporaryPath folder("x");
    const auto directory = read_npy(folder.path() + "/..");
    ASSERT_FALSE(directory);
    EXPECT_EQ(directory.failure().message, "no such file");
    const auto here = read_npy(kFolder);
    ASSERT_FALSE(here);
    EXPECT_EQ(here.failure().message, "is a directory, expected a file");
}

TEST(ReadArray, EndingDecides) {
    ASSERT_TRUE(read_array(kFolder + "f4_c.npy", ""));
    ASSERT_TRUE(read_array(kFolder + "stored.npz", "goal"));
    const auto other = read_array("goal.txt", "");
    ASSERT_FALSE(other);
    EXPECT_EQ(other.failure().code, Code::unknown_data_format);
    EXPECT_EQ(other.failure().message, "unknown kind of data file, expected .npy or .npz");
    const auto key = read_array(kFolder + "f4_c.npy", "goal");
    ASSERT_FALSE(key);
    EXPECT_EQ(key.failure().code, Code::key_without_archive);
    EXPECT_EQ(key.failure().message,
              "an .npy file holds one array without a name, so the key 'goal' has no meaning");
}

}  // namespace
}  // namespace etlc::data
