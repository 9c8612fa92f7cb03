// The frames in which messages come: headers, an empty line, content.
// Takes: bytes, in pieces of any size. Gives: the content of each message, or what is wrong with a
// frame. Keeps true: any bytes can be read, in linear time; no more than kMostContent bytes are
// kept; after a broken frame it goes on with the next Content-Length.
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
    std::string mistake;  ///< "" for a good one
};

class Reader {
public:
    void add(std::string_view bytes);
    /// Nothing: more bytes are needed.
    std::optional<Frame> next();

private:
    std::optional<Frame> end_of_headers();
    void take_header(std::string line);
    std::optional<std::string> line();
    std::optional<Frame> content();
    void forget_consumed();

    std::string bytes_;
    std::size_t at_ = 0;        ///< of `bytes_`: what has been consumed
    std::size_t searched_ = 0;  ///< up to here there is no line end
    bool in_content_ = false;
    std::optional<std::uint64_t> length_;
    std::uint64_t skipped_ = 0;  ///< of content that is too long
    std::string mistake_;        ///< in the headers so far
    bool has_headers_ = false;
};

}  // namespace etlc::lsp
