#include <gtest/gtest.h>

#include "source/source.hpp"

namespace {

using etlc::source::File;
using etlc::source::Position;
using etlc::source::Span;

void expect_position(const File& file, std::uint32_t offset, std::uint32_t line,
                     std::uint32_t column) {
    const Position at = file.position(offset);
    EXPECT_EQ(at.line, line) << "at offset " << offset;
    EXPECT_EQ(at.column, column) << "at offset " << offset;
}

TEST(Source, EmptyFileHasOneEmptyLine) {
    const File file("a.etl", "");
    EXPECT_EQ(file.line_count(), 1U);
    EXPECT_EQ(file.line_text(1), "");
    expect_position(file, 0, 1, 1);
}

TEST(Source, PositionsOfLines) {
    const File file("a.etl", "ab\ncd\n");
    expect_position(file, 0, 1, 1);
    expect_position(file, 2, 1, 3);
    expect_position(file, 3, 2, 1);
    expect_position(file, 6, 3, 1);
    EXPECT_EQ(file.line_count(), 3U);
    EXPECT_EQ(file.line_text(2), "cd");
    EXPECT_EQ(file.line_text(3), "");
}

TEST(Source, OffsetsPastTheEndAreItsEnd) {
    const File file("a.etl", "ab\ncd");
    expect_position(file, 400, 2, 3);
}

TEST(Source, CarriageReturnsBelongToTheLineEnd) {
    const File file("a.etl", "ab\r\ncd\r\n");
    EXPECT_EQ(file.line_text(1), "ab");
    EXPECT_EQ(file.line_text(2), "cd");
    expect_position(file, 4, 2, 1);
}

TEST(Source, ColumnsCountCodePoints) {
    const File file("a.etl", "\xC3\xA9\xE6\x97\xA5x");  // é日x
    expect_position(file, 2, 1, 2);
    expect_position(file, 5, 1, 3);
    expect_position(file, 6, 1, 4);
}

TEST(Source, ColumnsAreExactInLongLines) {
    std::string text = "first\n";
    for (int i = 0; i < 5000; ++i)
        text += "\xC3\xA9";  // two bytes each, so blocks split characters
    const File file("a.etl", text);
    for (std::uint32_t i = 0; i < 5000; ++i) expect_position(file, 6 + 2 * i, 2, i + 1);
}

TEST(Source, TextOfSpans) {
    const File file("a.etl", "hello");
    EXPECT_EQ(file.text(Span{1, 3}), "el");
    EXPECT_EQ(file.text(Span{3, 900}), "lo");
    EXPECT_EQ(file.text(Span{900, 901}), "");
    EXPECT_EQ(file.text(Span{3, 1}), "");
}

TEST(Source, JoinCoversBoth) {
    EXPECT_EQ(join(Span{4, 5}, Span{1, 2}), (Span{1, 5}));
    EXPECT_EQ(join(Span{1, 9}, Span{2, 3}), (Span{1, 9}));
}

}  // namespace
