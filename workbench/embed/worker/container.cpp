#include "embed/worker/container.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

namespace etlc::embed::worker {

namespace {

// https://www.rfc-editor.org/rfc/rfc8794 (EBML), section 11, and RFC 9559 (Matroska)
constexpr std::uint64_t kHead = 0x1A45DFA3;
constexpr std::uint64_t kSegment = 0x18538067;

/// Reads elements of EBML: an identifier, a size, and so many bytes.
class Elements {
public:
    explicit Elements(std::istream& from) : from_(from) {}

    std::optional<std::uint64_t> identifier() { return number(true); }
    /// Nothing where it is not known, as of a live stream.
    std::optional<std::uint64_t> size() { return number(false); }

private:
    /// As many bytes as the first has leading zeros, and one more.
    std::optional<std::uint64_t> number(bool with_mark) {
        const int first = from_.get();
        if (first <= 0) return std::nullopt;
        const auto more = static_cast<unsigned>(std::countl_zero(static_cast<std::uint8_t>(first)));
        std::uint64_t value = static_cast<unsigned>(first) & (with_mark ? 0xFFU : 0x7FU >> more);
        for (unsigned i = 0; i < more; ++i) {
            const int byte = from_.get();
            if (byte < 0) return std::nullopt;
            value = value << 8U | static_cast<unsigned>(byte);
        }
        const std::uint64_t unknown = (std::uint64_t{1} << 7U * (more + 1)) - 1;
        if (!with_mark && value == unknown) return std::nullopt;
        return value;
    }

    std::istream& from_;
};

std::string why_cut_matroska(std::ifstream& file, std::uint64_t length) {
    Elements elements(file);
    if (elements.identifier() != kHead) return "";
    const auto head = elements.size();
    if (!head || *head > length) return "";
    file.seekg(static_cast<std::streamoff>(*head), std::ios::cur);
    if (elements.identifier() != kSegment) return "";
    const auto segment = elements.size();
    if (!segment) return "";
    const std::uint64_t end = static_cast<std::uint64_t>(file.tellg()) + *segment;
    if (end <= length) return "";
    return "is cut: it has " + std::to_string(length) + " bytes, expected " + std::to_string(end);
}

}  // namespace

std::string why_cut(const std::string& path) {
    std::error_code error;
    const std::uint64_t length = std::filesystem::file_size(path, error);
    std::ifstream file(path, std::ios::binary);
    if (error || !file) return "";
    std::array<char, 4> begin{};
    file.read(begin.data(), begin.size());
    if (std::string_view(begin.data(), begin.size()) == "GIF8") {
        file.seekg(-1, std::ios::end);
        return file.get() == ';' ? "" : "is cut: its end is missing";
    }
    file.clear();
    file.seekg(0);
    return why_cut_matroska(file, length);
}

}  // namespace etlc::embed::worker
