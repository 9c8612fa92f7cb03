// Splits the input of the server into messages: headers, an empty line, content.
// Takes: bytes, in pieces of any size. Gives: the content of each message, or an error in a frame.
// Keeps true: any bytes are accepted, in linear time; at most kMostContent bytes are kept; after a
// broken frame it continues with the next Content-Length.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace etlc::lsp {

/// The largest spec (1 MiB), each byte of it escaped.
inline constexpr std::uint64_t kMostContent = 8U << 20U;

struct Frame {
    std::string content;
    std::string mistake;  ///< error; "" for a valid frame
};

class Reader {
public:
    void add(std::string_view bytes);
    /// Returns the next frame; nothing where more bytes are needed.
    std::optional<Frame> next();

private:
    std::optional<Frame> end_of_headers();
    void take_header(std::string line);
    std::optional<std::string> line();
    std::optional<Frame> content();
    void forget_consumed();

    std::string bytes_;
    std::size_t at_ = 0;        ///< consumed bytes of `bytes_`
    std::size_t searched_ = 0;  ///< no line end before this place
    bool in_content_ = false;
    std::optional<std::uint64_t> length_;
    std::uint64_t skipped_ = 0;  ///< remaining bytes of content that is too long
    std::string mistake_;        ///< error in the headers so far
    bool has_headers_ = false;
};

}  // namespace etlc::lsp
