// Tests .csv traces: contents, missing samples, and errors with their places.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <locale>

#include "data/text/text.hpp"
#include "data/traces/csv.hpp"
#include "data/traces/trace_formats.hpp"
#include "npy_bytes.hpp"
#include "recordings/open.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

using diag::Code;
using diag::Failure;

const std::vector<Channel> kChannels{{"z", Channel::Kind::vector, 2},
                                     {"grip", Channel::Kind::scalar, 1},
                                     {"held", Channel::Kind::boolean, 1}};

/// Returns all steps as text: "1 2|0.5|1", "-" for a missing channel; then the failure that ended
/// it.
struct Read {
    std::vector<std::string> steps;
    std::optional<Failure> failure;
};

std::string text(const Sample& sample) {
    std::string result;
    for (std::size_t c = 0; c < sample.values.size(); ++c) {
        if (c > 0) result += "|";
        std::string values;
        for (const double value : sample.values[c]) {
            // Missing samples have no number that could be used by mistake.
            EXPECT_TRUE(sample.present[c] || std::isnan(value));
            std::ostringstream number;
            number << value;
            values += fmt::format("{}{}", values.empty() ? "" : " ", number.str());
        }
        result += sample.present[c] ? values : "-";
    }
    return result;
}

Read read(std::string_view bytes, const std::vector<Channel>& channels = kChannels) {
    Read result;
    auto trace = open_csv_trace(from_memory(bytes), channels);
    if (!trace) {
        result.failure = trace.failure();
        return result;
    }
    EXPECT_EQ((*trace)->length(), 0U);
    Sample sample;
    for (;;) {
        const auto more = (*trace)->next(sample);
        if (!more) result.failure = more.failure();
        if (!more || !*more) return result;
        result.steps.push_back(text(sample));
    }
}

struct Sound {
    std::string what;
    std::string bytes;
    std::vector<std::string> steps;
};

TEST(CsvTrace, AnOptionalColumnMayBeAbsent) {
    const std::vector<Channel> channels{{"truth.at_a", Channel::Kind::boolean, 1, true},
                                        {"grip", Channel::Kind::scalar, 1},
                                        {"v", Channel::Kind::vector, 2, true}};
    const std::string lacking = "grip\n1\n2\n";
    EXPECT_EQ(read(lacking, channels).steps, (std::vector<std::string>{"-|1|-", "-|2|-"}));
    EXPECT_EQ(read("grip,truth.at_a\n1,0\n2,\n", channels).steps,
              (std::vector<std::string>{"0|1|-", "-|2|-"}));
    auto trace = open_csv_trace(from_memory(lacking), channels);
    ASSERT_TRUE(trace);
    EXPECT_FALSE((*trace)->has(0));
    EXPECT_TRUE((*trace)->has(1));
    // Half a vector is not a missing one.
    const auto half = open_csv_trace(from_memory("grip,v[0]\n"), channels);
    ASSERT_FALSE(half);
    EXPECT_EQ(half.failure().code, Code::no_such_channel);
}

TEST(Csv, Sound) {
    const std::string bom = "\xef\xbb\xbf";
    const std::string head = "z[0],z[1],grip,held\n";
    const Sound table[] = {
        {"header only", head, {}},
        {"rows", head + "1,2,0.5,1\n3,4,-0.25,0\n", {"1 2|0.5|1", "3 4|-0.25|0"}},
        {"no line end at the end", head + "1,2,0.5,1", {"1 2|0.5|1"}},
        {"CRLF", "z[0],z[1],grip,held\r\n1,2,0.5,1\r\n", {"1 2|0.5|1"}},
        {"byte order mark", bom + head + "1,2,0.5,1\n", {"1 2|0.5|1"}},
        {"another order, extra columns",
         "t,held,z[1],note,grip,z[0]\n0.1,1,2,\"a, b\n c\",0.5,1\n0.2,0,4,,0.5,3\n",
         {"1 2|0.5|1", "3 4|0.5|0"}},
        {"quotes",
         "\"z[0]\",\"z[1]\",\"grip\",\"held\"\n\"1\",\"2\",\"0.5\",\"1\"\n",
         {"1 2|0.5|1"}},
        {"quotes in quotes",
         "z[0],z[1],grip,held,\"say \"\"z\"\"\"\n1,2,0.5,1,\"\"\"\"\n",
         {"1 2|0.5|1"}},
        {"blanks", "z[0], z[1] ,grip\t, held\n 1 ,2, 0.5,\t1\n", {"1 2|0.5|1"}},
        {"empty cells",
         head + ",2,,\n1,,0.5,1\n,,,\n\"\",\"\",\"\",\"\"\n",
         {"-|-|-", "-|0.5|1", "-|-|-", "-|-|-"}},
        {"numbers", head + "1e3,+.5,1E-3,1.0\n-0,5.,0x0,0\n", {"1000 0.5|0.001|1"}},
        {"bools of pandas", head + "1,2,0.5,True\n3,4,0.5, False \n", {"1 2|0.5|1", "3 4|0.5|0"}},
        {"bools of others",
         head + "1,2,0,true\n1,2,0,FALSE\n1,2,0,\"TRUE\"\n1,2,0,false\n",
         {"1 2|0|1", "1 2|0|0", "1 2|0|1", "1 2|0|0"}},
        {"not finite",
         head + "nan,2,inf,NaN\n-Infinity,NAN,1e999,-inf\n",
         {"nan 2|nan|nan", "nan nan|nan|nan"}},
        {"too small", head + "1e-999,-1e-999,0.0000001e-330,0\n", {"0 -0|0|0"}},
        {"extra quoted text in UTF-8",
         "z[0],z[1],grip,held,ort\n1,2,0.5,1,\"Z\xc3\xbcrich\"\n",
         {"1 2|0.5|1"}},
    };
    for (const Sound& one : table) {
        const Read got = read(one.bytes);
        const bool hexadecimal = one.what == "numbers";  // its second row is not a number
        EXPECT_EQ(got.failure.has_value(), hexadecimal)
            << one.what << (got.failure ? got.failure->message : "");
        EXPECT_EQ(got.steps, one.steps) << one.what;
    }
}

/// Returns a text in UTF-16 with its byte order mark, and a character beyond the first 65536.
std::string utf16(const std::string& text, bool is_little) {
    std::string bytes;
    const auto add = [&](unsigned unit) {
        const std::string big = {static_cast<char>(unit / 256), static_cast<char>(unit % 256)};
        bytes += is_little ? std::string(big.rbegin(), big.rend()) : big;
    };
    add(0xfeff);
    for (const char c : text) add(static_cast<unsigned char>(c));
    for (const unsigned unit : {0x20acU, 0xe9U, 0xd83dU, 0xde00U}) add(unit);
    return bytes;
}

TEST(Csv, AsSpreadsheetsWriteIt) {
    const std::vector<std::string> steps{"1 2|0.5|1", "-|-|0"};
    const std::string commas = "z[0],z[1],grip,held\r\n1,2,0.5,1\r\n,,,0\r\n";
    const auto with = [&](char separator, const std::string& half) {
        std::string bytes = commas;
        std::replace(bytes.begin(), bytes.end(), ',', separator);
        bytes.replace(bytes.find("0.5"), 3, half);
        return bytes;
    };
    const std::string bom = "\xef\xbb\xbf";
    for (const std::string& bytes :
         {commas, commas + "\r\n\r\n", with(';', "0,5"), with(';', "0.5"), bom + with(';', "0,5"),
          "sep=;\r\n" + with(';', "0,5"), bom + "sep=,\n" + commas, "sep=\t\n" + with('\t', "0.5"),
          with('\t', "0.5"), with(';', "\"0,5\""), "\"z[0]\"" + with(';', "0,5").substr(4)}) {
        const Read got = read(bytes);
        EXPECT_FALSE(got.failure) << bytes << got.failure->message;
        EXPECT_EQ(got.steps, steps) << bytes;
    }
    for (const bool is_little : {true, false}) {
        const std::string unicode =
            utf16("z[0]\tz[1]\tgrip\theld\tnote\n1\t2\t0.5\t1\t", is_little);
        const Read got = read(unicode);
        EXPECT_FALSE(got.failure) << got.failure->message;
        EXPECT_EQ(got.steps, (std::vector<std::string>{"1 2|0.5|1"}));
        CsvReader reader(from_memory(unicode));
        ASSERT_TRUE(reader.next());
        ASSERT_TRUE(reader.next());
        EXPECT_EQ(reader.cell(4), "\xe2\x82\xac\xc3\xa9\xf0\x9f\x98\x80");
    }
}

TEST(Csv, OneColumnAndEmptyLines) {
    const Read got = read("grip\n1\n\n2\n", {{"grip", Channel::Kind::scalar, 1}});
    EXPECT_FALSE(got.failure);
    EXPECT_EQ(got.steps, (std::vector<std::string>{"1", "-", "2"}));
}

TEST(Csv, NoChannelsStillHasSteps) {
    const Read got = read("a,b\n1,2\n3,x\n", {});
    EXPECT_FALSE(got.failure);
    EXPECT_EQ(got.steps.size(), 2U);
}

struct Broken {
    std::string what;
    std::string bytes;
    Code code;
    std::uint32_t line;
    std::uint32_t column;
    std::string message;
};

std::vector<Broken> broken() {
    const std::string head = "z[0],z[1],grip,held\n";
    std::string many = "t0";
    for (int i = 1; i < 12; ++i) many += ",t" + std::to_string(i);
    return {
        {"empty", "", Code::malformed_csv, 0, 0,
         "is empty, expected a row with the names of the columns"},
        {"half a character of UTF-16", std::string("\xff\xfez\0y", 5), Code::malformed_csv, 0, 0,
         "is UTF-16 that is damaged: save it as UTF-8"},
        {"half a pair of UTF-16", std::string("\xfe\xff\xd8\x01\0y", 6), Code::malformed_csv, 0, 0,
         "is UTF-16 that is damaged: save it as UTF-8"},
        {"decimal comma between tabs", "z[0]\tz[1]\tgrip\theld\n1\t2\t0,5\t1\n", Code::not_a_number,
         2, 5, "column 'grip' holds '0,5', expected a number with a decimal point"},
        {"comma and point", "z[0];z[1];grip;held\n1.5;2;0,5;1\n", Code::not_a_number, 2, 7,
         "column 'grip' holds '0,5', expected a number with a decimal point, as before it"},
        {"point and comma", "z[0];z[1];grip;held\n1,5;2;0.5;1\n", Code::not_a_number, 2, 7,
         "column 'grip' holds '0.5', expected a number with a decimal comma, as before it"},
        {"thousands", "z[0];z[1];grip;held\n1.000,5;2;0;1\n", Code::not_a_number, 2, 1,
         "column 'z[0]' holds '1.000,5', expected a number"},
        {"two commas", "z[0];z[1];grip;held\n1,000,5;2;0;1\n", Code::not_a_number, 2, 1,
         "column 'z[0]' holds '1,000,5', expected a number"},
        {"semicolon after a quote", "z[0];z[1];grip;held\n\"1\"x;2;0;1\n", Code::malformed_csv, 2,
         4, "'x' after a closing quote, expected a semicolon or the end of the line"},
        {"absent", "z[0],z[1],gripp,held\n", Code::no_such_channel, 1, 1,
         "no column 'grip'; did you mean 'gripp'?"},
        {"absent, nothing near", many + "\n", Code::no_such_channel, 1, 1,
         "no column 'z[0]', needed by input 'z' of 2 elements; there are 't0', 't1', 't2', 't3', "
         "'t4', 't5', 't6', 't7', 't8', 't9' and 2 more"},
        {"vector too short", "z[0],grip,held\n", Code::no_such_channel, 1, 1,
         "no column 'z[1]', needed by input 'z' of 2 elements; there are 'z[0]', 'grip' and "
         "'held'"},
        {"vector too long", "z[0],z[1],z[2],grip,held\n", Code::trace_shape, 1, 1,
         "has a column 'z[2]', but input 'z' has 2 elements"},
        {"column twice", "z[0],grip,z[1],grip,held\n", Code::no_such_channel, 1, 1,
         "2 columns are named 'grip'"},
        {"too few cells", head + "1,2,0.5,1\n1,2,0.5\n", Code::malformed_csv, 3, 1,
         "row has 3 cells, the header has 4"},
        {"too many cells", head + "1,2,0.5,1,\n", Code::malformed_csv, 2, 1,
         "row has 5 cells, the header has 4; where a comma is the decimal point, semicolons "
         "separate cells"},
        {"empty line", head + "\n\n1,2,0.5,1\n", Code::malformed_csv, 2, 1,
         "is an empty line before the last row; a step without samples has 4 empty cells"},
        {"no number", head + "1,2,0.5,1\n1, abc,0.5,1\n", Code::not_a_number, 3, 4,
         "column 'z[1]' holds 'abc', expected a number"},
        {"no number after a line break in quotes", "n,z[0],z[1],grip,held\n\"a\nb\",1,2,?,1\n",
         Code::not_a_number, 3, 8, "column 'grip' holds '?', expected a number"},
        {"no number after UTF-8", "n,z[0],z[1],grip,held\n\xc3\xbc,1,2,?,1\n", Code::not_a_number,
         2, 7, "column 'grip' holds '?', expected a number"},
        {"decimal comma", head + "1,2,\"0,5\",1\n", Code::not_a_number, 2, 5,
         "column 'grip' holds '0,5', expected a number with a decimal point"},
        {"two numbers", head + "1 2,2,0.5,1\n", Code::not_a_number, 2, 1,
         "column 'z[0]' holds '1 2', expected a number"},
        {"hexadecimal", head + "0x1,2,0.5,1\n", Code::not_a_number, 2, 1,
         "column 'z[0]' holds '0x1', expected a number"},
        {"two signs", head + "+-1,2,0.5,1\n", Code::not_a_number, 2, 1,
         "column 'z[0]' holds '+-1', expected a number"},
        {"control characters", head + "\x1b[31m,2,0.5,1\n", Code::not_a_number, 2, 1,
         "column 'z[0]' holds '\\x1b[31m', expected a number"},
        {"NUL", head + std::string("1\0,2,0.5,1\n", 11), Code::not_a_number, 2, 1,
         "column 'z[0]' holds '1\\x00', expected a number"},
        {"long text", head + std::string(100, 'x') + ",2,0.5,1\n", Code::not_a_number, 2, 1,
         "column 'z[0]' holds '" + std::string(60, 'x') + "...', expected a number"},
        {"bool", head + "1,2,0.5,2\n", Code::not_a_number, 2, 9,
         "column 'held' holds '2', expected 0 or 1, True or False"},
        {"bool in words", head + "1,2,0.5,yes\n", Code::not_a_number, 2, 9,
         "column 'held' holds 'yes', expected 0 or 1, True or False"},
        {"quote within", head + "1,2\",0.5,1\n", Code::malformed_csv, 2, 4,
         "quote within a cell that does not begin with one"},
        {"after a quote", head + "\"1\"x,2,0.5,1\n", Code::malformed_csv, 2, 4,
         "'x' after a closing quote, expected a comma or the end of the line"},
        {"open quote", head + "1,\"2,0.5,1\n3,4,0.5,1\n", Code::malformed_csv, 2, 3,
         "quote that is not closed before the end of the file"},
        {"open quote in the header", "z[0],\"z[1],grip,held\n", Code::malformed_csv, 1, 6,
         "quote that is not closed before the end of the file"},
        {"lone CR", head + "1,2,0.5,1\r3,4,0.5,1\r", Code::malformed_csv, 2, 10,
         "carriage return without a line feed"},
        {"long row", head + std::string(kMaxRowBytes + 1, '1') + "\n", Code::malformed_csv, 2, 1,
         "row is longer than 4194304 bytes, the most that is read"},
        {"long row of quotes", head + "\"" + std::string(kMaxRowBytes + 1, '\n') + "\"\n",
         Code::malformed_csv, 2, 1, "row is longer than 4194304 bytes, the most that is read"},
        {"many cells", head + std::string(kMaxRowBytes + 1, ',') + "\n", Code::malformed_csv, 2, 1,
         "row is longer than 4194304 bytes, the most that is read"},
        {"long header", std::string(kMaxRowBytes + 1, ','), Code::malformed_csv, 1, 1,
         "row is longer than 4194304 bytes, the most that is read"},
    };
}

TEST(Csv, EveryFaultHasItsPlaceAndMessage) {
    for (const Broken& one : broken()) {
        const Read got = read(one.bytes);
        ASSERT_TRUE(got.failure) << one.what;
        EXPECT_EQ(got.failure->code, one.code) << one.what;
        EXPECT_EQ(got.failure->message, one.message) << one.what;
        EXPECT_EQ(got.failure->line, one.line) << one.what;
        EXPECT_EQ(got.failure->column, one.column) << one.what;
    }
}

TEST(Csv, OfTheTimesWhatIsNoNumberIsMissing) {
    const std::vector<Channel> channels{{"g", Channel::Kind::scalar, 1},
                                        {"time", Channel::Kind::scalar, 1, true}};
    auto trace = open_csv_trace(from_memory("time,g\n0.5,1\n12:30,2\n,3\n"), channels);
    ASSERT_TRUE(trace);
    Sample sample;
    for (const bool present : {true, false, false}) {
        const auto more = (*trace)->next(sample);
        ASSERT_TRUE(more && *more);
        EXPECT_TRUE(sample.present[0]);
        EXPECT_EQ(sample.present[1], present);
    }
    auto twice = open_csv_trace(from_memory("time,g,time\n0.5,1,2\n"), channels);
    ASSERT_TRUE(twice);
    EXPECT_FALSE((*twice)->has(1));
}

TEST(Csv, AFailureStays) {
    const std::string bytes = "z[0],z[1],grip,held\n\"1\"x\n1,2,3,1\n";
    auto trace = open_csv_trace(from_memory(bytes), kChannels);
    ASSERT_TRUE(trace);
    Sample sample;
    for (int i = 0; i < 3; ++i) EXPECT_FALSE((*trace)->next(sample));
}

/// Returns bytes in pieces of any size, to put buffer boundaries everywhere.
class Pieces final : public ByteSource {
public:
    Pieces(std::string_view bytes, std::size_t piece) : rest_(bytes), piece_(piece) {}
    diag::Result<std::size_t> read(char* to, std::size_t n) override {
        n = std::min({n, piece_, rest_.size()});
        std::copy_n(rest_.data(), n, to);
        rest_.remove_prefix(n);
        return n;
    }
    std::uint64_t size() const override { return 0; }

private:
    std::string_view rest_;
    std::size_t piece_;
};

TEST(Csv, SeamsOfTheBufferDoNotShow) {
    const std::string bytes =
        "n,\"z[0]\",z[1],grip,held\r\n\"a\"\"\r\nb\",1.25,2.5,\"3\",1\r\nx,4,5,,0\r\n";
    const std::vector<std::string> expected{"1.25 2.5|3|1", "4 5|-|0"};
    for (std::size_t piece = 3; piece <= bytes.size(); ++piece) {
        auto trace = open_csv_trace(std::make_unique<Pieces>(bytes, piece), kChannels);
        ASSERT_TRUE(trace) << trace.failure().message;
        Sample sample;
        for (const std::string& step : expected) {
            const auto more = (*trace)->next(sample);
            ASSERT_TRUE(more) << more.failure().message;
            ASSERT_TRUE(*more);
            EXPECT_EQ(text(sample), step) << piece;
        }
        EXPECT_FALSE(*(*trace)->next(sample));
    }
}

TEST(Csv, OpenedByItsEnding) {
    const tests::TemporaryPath file("run.csv", "z[0],z[1],grip,held\n1,2,0.5,1\n");
    auto trace = open_trace(file.path(), kChannels);
    ASSERT_TRUE(trace) << trace.failure().message;
    const tests::TemporaryPath other("run.txt", "");
    const auto unknown = open_trace(other.path(), kChannels);
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.failure().code, Code::unknown_trace_format);
    EXPECT_EQ(unknown.failure().message,
              "unknown kind of trace, expected .csv, .npz, .h5 or .hdf5");
    for (const char* ending : {".csv", ".npz"}) {
        const auto missing = open_trace(std::string("no_such") + ending, kChannels);
        ASSERT_FALSE(missing);
        EXPECT_EQ(missing.failure().code, Code::unreadable_trace);
        EXPECT_EQ(missing.failure().message, "no such file");
    }
}

TEST(Number, WholeTextOrNothing) {
    const std::string one_and_zeros = std::string("1").append(400, '0');
    EXPECT_EQ(parse_number("0.1"), 0.1);
    EXPECT_EQ(parse_number("4.9406564584124654e-324"), 4.9406564584124654e-324);
    EXPECT_EQ(parse_number("1.7976931348623157e308"), 1.7976931348623157e308);
    EXPECT_EQ(parse_number("1e309"), INFINITY);
    EXPECT_EQ(parse_number("-1e309"), -INFINITY);
    EXPECT_EQ(parse_number(one_and_zeros), INFINITY);
    EXPECT_EQ(parse_number(one_and_zeros + "e-400"), 1.0);
    EXPECT_EQ(parse_number("0." + std::string(400, '0') + "1"), 0.0);
    EXPECT_EQ(parse_number("1e99999999999999999999999"), INFINITY);
    EXPECT_EQ(parse_number("1e-99999999999999999999999"), 0.0);
    for (const char* text : {"", "+", "-", ".", "e5", "1e", "1 ", " 1", "1,5", "0x10", "--1", "+-1",
                             "1f", "nanx", "one"})
        EXPECT_FALSE(parse_number(text)) << text;
}

}  // namespace
}  // namespace etlc::recordings
