// Tests positions in a text in UTF-16 and in UTF-8, and names of documents.
#include <gtest/gtest.h>

#include "lsp/spec/analysis.hpp"
#include "lsp/text/json.hpp"

namespace etlc::lsp {
namespace {

// a, characters of two, three and four bytes; then all three kinds of line ends.
const std::string kText = "a\u00e9\u20ac\U0001F600b\r\nc\rd\n";

TEST(Position, CountsUnitsOrBytes) {
    const Lines utf16(kText, Encoding::utf16);
    const Lines utf8(kText, Encoding::utf8);
    EXPECT_EQ(utf16.count(), 4U);
    EXPECT_EQ(utf16.offset({0, 3}), 6U);
    EXPECT_EQ(utf16.offset({0, 5}), 10U);
    EXPECT_EQ(utf8.offset({0, 10}), 10U);
    EXPECT_EQ(utf16.position(10), (Position{0, 5}));
    EXPECT_EQ(utf8.position(10), (Position{0, 10}));
    EXPECT_EQ(utf16.offset({1, 1}), 14U);
    EXPECT_EQ(utf16.offset({2, 0}), 15U);
    EXPECT_EQ(utf16.position(15), (Position{2, 0}));
}

TEST(Position, EveryPlaceIsInTheText) {
    for (const Encoding encoding : {Encoding::utf16, Encoding::utf8}) {
        const Lines lines(kText, encoding);
        const std::uint32_t inside = encoding == Encoding::utf16 ? 4 : 8;
        EXPECT_EQ(lines.offset({0, inside}), 6U) << "inside a character is before it";
        EXPECT_EQ(lines.offset({0, 4'000'000'000}), 11U) << "behind a line is its end";
        EXPECT_EQ(lines.offset({4'000'000'000, 0}), kText.size());
        EXPECT_EQ(lines.offset({3, 7}), kText.size());
        for (std::uint32_t at = 0; at <= kText.size() + 2; ++at) {
            const Position position = lines.position(at);
            const std::uint32_t back = lines.offset(position);
            EXPECT_LE(back, at);
            EXPECT_EQ(lines.position(back), position);
        }
    }
    EXPECT_EQ(Lines("", Encoding::utf16).offset({0, 3}), 0U);
    EXPECT_EQ(Lines("\xFF\xFF", Encoding::utf16).offset({0, 1}), 1U);
}

TEST(Document, EditsThatEndBeforeTheyBeginAreTurned) {
    Document document("file:///a.etl", "one two", 1, Encoding::utf16);
    document.replace(Range{{0, 7}, {0, 4}}, "2");
    EXPECT_EQ(document.text(), "one 2");
    document.replace(Range{{9, 9}, {0, 0}}, "");
    EXPECT_EQ(document.text(), "");
}

TEST(Uri, IsAPathAndBack) {
    EXPECT_EQ(path_of_uri("file:///a%20b/%C3%A9.etl"), "/a b/\u00e9.etl");
    EXPECT_EQ(path_of_uri("file://host/a.etl"), "/a.etl");
    EXPECT_EQ(path_of_uri("file:///100%.etl"), "/100%.etl");
    EXPECT_EQ(path_of_uri("file:///%zz%4"), "/%zz%4");
    EXPECT_EQ(path_of_uri("untitled:Untitled-1"), "Untitled-1");
    EXPECT_EQ(path_of_uri(""), "");
    EXPECT_EQ(path_of_uri("file://"), "");
    EXPECT_EQ(uri_of_path("/a b/\u00e9.etl"), "file:///a%20b/%C3%A9.etl");
    EXPECT_EQ(path_of_uri(uri_of_path("/x/%41#?.etl")), "/x/%41#?.etl");
}

}  // namespace
}  // namespace etlc::lsp
