// What `etlc label` or `etlc watch` and `etlc-serve` say to each other. To etlc-serve, on its
// standard input: the port (0: any free one) and the token of the address; then for each request an
// answer: status, type of the content, content; between answers events: the status kEvent and the
// text. The answer to "/events" is the first event of the page that asked, which then gets all
// events that come later; "/events/end" says that such a page has gone. From it, on its standard
// output: the port; then requests: the path behind the token, and the content. Numbers have 32
// bits, little-endian; texts follow their length. The last line of its standard error explains a
// failure.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "recordings/frames/protocol.hpp"

namespace etlc::label::protocol {

inline constexpr std::size_t kTokenSize = 32;             ///< characters: hexadecimal digits
inline constexpr std::uint32_t kMostContent = 1U << 20U;  ///< bytes of a request
inline constexpr std::uint32_t kMostAnswer = 1U << 30U;   ///< bytes of an answer

inline constexpr std::uint32_t kEvent = 0;  ///< in place of a status

inline void append(std::string& bytes, std::string_view text) {
    recordings::frames::append(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += text;
}

}  // namespace etlc::label::protocol
