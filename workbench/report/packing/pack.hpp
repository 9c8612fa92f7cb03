// Many numbers as a short text, which the page unpacks when it shows them.
// Takes: series of numbers, a step each. Gives: base64 of deflated bytes: the length of a head of
// JSON text in 4 bytes, the head, then the series, byte by byte of all their numbers, which
// deflates better than number by number. Keeps true: what is exact reads back to the same bits;
// what is rounded to so many parts is off by at most half a part of the span of its series;
// infinite and missing numbers stay so.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::report {

std::string base64(std::string_view bytes);

/// As zlib's format has it (RFC 1950).
std::string deflated(std::string_view bytes);

/// The series that the head describes, in the order of their addition. Each function gives what the
/// head has to say of the series, as JSON.
class Packing {
public:
    /// float32, as they are.
    std::string exact(const std::vector<float>& numbers);
    /// In `parts` steps of the span, even and at most 32,000; differences from one to the next.
    std::string rounded(const std::vector<float>& numbers, int parts);
    /// Whole numbers, in as many bytes as the greatest takes.
    std::string whole(const std::vector<std::uint32_t>& numbers);

    std::string packed(std::string_view head) const;

private:
    void add_bytes(const std::vector<std::uint32_t>& words, std::size_t bytes);

    std::string body_;
};

}  // namespace etlc::report
