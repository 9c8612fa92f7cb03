// Reads messages in pieces of any size.
#include <gtest/gtest.h>

#include "lsp/protocol/session.hpp"
#include "lsp/text/json.hpp"

namespace etlc::lsp {
namespace {

/// Returns the contents of all messages, with errors in angle brackets.
std::string read(const std::string& bytes, std::size_t piece) {
    Reader reader;
    std::string all;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
        reader.add(std::string_view(bytes).substr(at, piece));
        while (auto frame = reader.next())
            all += (frame->mistake.empty() ? frame->content : "<" + frame->mistake + ">") + ";";
    }
    return all;
}

TEST(Reader, TheSizeOfPiecesDoesNotCount) {
    const std::string bytes =
        "Content-Length: 2\r\n\r\n{}content-length:3\nContent-Type: x; charset=utf-8\n\n[1]"
        "\r\n\r\nContent-Length: 0\r\n\r\nno header\r\n\r\nrestContent-Length: 1\r\n\r\n4";
    const std::string expected =
        "{};[1];;<expected a header, found something else>;"
        "<expected a header, found something else>;4;";
    for (std::size_t piece = 1; piece < bytes.size() + 1; ++piece)
        EXPECT_EQ(read(bytes, piece), expected) << piece;
}

TEST(Reader, ALongMessageIsPassedOver) {
    const std::string length = std::to_string(kMostContent + 1);
    const std::string bytes = "Content-Length: " + length + "\r\n\r\n" +
                              std::string(kMostContent + 1, 'x') + "Content-Length: 1\r\n\r\n4";
    for (const std::size_t piece : {std::size_t{65536}, bytes.size()})
        EXPECT_EQ(read(bytes, piece),
                  "<a message of " + length + " bytes; at most 8388608 are read>;4;");
}

TEST(Reader, AHeaderWithoutEndIsNotKept) {
    const std::string bytes = std::string(1'000'000, 'x') + "Content-Length: 1\r\n\r\n4";
    EXPECT_EQ(read(bytes, 100), "<expected a header, found something else>;4;");
    EXPECT_EQ(read(std::string(1'000'000, 'x'), 1000), "");
}

TEST(Json, DepthIsCountedOutsideStrings) {
    EXPECT_FALSE(nests_too_deep(std::string(256, '[')));
    EXPECT_TRUE(nests_too_deep(std::string(257, '[')));
    EXPECT_FALSE(nests_too_deep("\"" + std::string(1000, '[')));
    EXPECT_FALSE(nests_too_deep("\"\\\"" + std::string(1000, '[')));
    EXPECT_TRUE(nests_too_deep("\"\\\\\"" + std::string(1000, '{')));
}

}  // namespace
}  // namespace etlc::lsp
