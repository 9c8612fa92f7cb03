#include "recordings/incident.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data/files/hash.hpp"
#include "etlmon/temporal/recorder.hpp"

namespace etlc::recordings {

using namespace data;

namespace {

using diag::Code;
using diag::Failure;

/// Reads numbers from bytes; the caller has checked that there are enough.
class Reader {
public:
    explicit Reader(std::string_view bytes) : bytes_(bytes) {}

    std::uint8_t byte() { return static_cast<std::uint8_t>(bytes_[at_++]); }
    std::uint32_t word() { return static_cast<std::uint32_t>(number(4)); }
    std::uint64_t long_word() { return number(8); }

private:
    std::uint64_t number(unsigned size) {
        std::uint64_t result = 0;
        for (unsigned i = 0; i < size; ++i) result |= std::uint64_t{byte()} << (8 * i);
        return result;
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
};

constexpr std::size_t kVersionEnd = sizeof etlmon::kIncidentMagic + 4;
constexpr std::size_t kLengthEnd = kVersionEnd + 4;
constexpr std::size_t kLeast = etlmon::kIncidentHeadBytes + etlmon::kIncidentChecksumBytes;

bool has_magic(std::string_view bytes) {
    return bytes.size() >= sizeof etlmon::kIncidentMagic &&
           std::equal(std::begin(etlmon::kIncidentMagic), std::end(etlmon::kIncidentMagic),
                      bytes.begin(), [](std::uint8_t expected, char found) {
                          return expected == static_cast<std::uint8_t>(found);
                      });
}

Failure damaged(std::string message) {
    return {Code::damaged_incident, std::move(message)};
}

/// Checks the head and the checksum of a file.
std::optional<Failure> why_unusable(std::string_view bytes) {
    if (!has_magic(bytes))
        return Failure{Code::unknown_incident_format, bytes.empty()
                                                          ? "an empty file, expected an incident"
                                                          : "does not begin as an incident does"};
    if (bytes.size() < kLengthEnd) return damaged(fmt::format("cut after {} bytes", bytes.size()));
    const std::uint32_t version = Reader(bytes.substr(sizeof etlmon::kIncidentMagic)).word();
    if (version != etlmon::kIncidentVersion)
        return Failure{Code::unknown_incident_format,
                       fmt::format("an incident of version {}, expected version {}", version,
                                   etlmon::kIncidentVersion)};
    const std::uint32_t length = Reader(bytes.substr(kVersionEnd)).word();
    if (bytes.size() != length || length < kLeast)
        return damaged(fmt::format("has {} bytes, and says that it has {}", bytes.size(), length));
    const std::size_t content = length - etlmon::kIncidentChecksumBytes;
    if (Reader(bytes.substr(content)).long_word() != xxh64(bytes.substr(0, content)))
        return damaged("was changed: its checksum does not fit");
    return std::nullopt;
}

}  // namespace

diag::Result<Incident> parse_incident(std::string_view bytes) {
    if (auto failure = why_unusable(bytes)) return std::move(*failure);
    Reader in(bytes.substr(kLengthEnd));
    Incident result;
    result.spec = in.long_word();
    result.data = in.long_word();
    result.thresholds = in.long_word();
    result.columns = in.long_word();
    const std::uint32_t words = in.word(), row_bytes = in.word();
    result.before = in.word();
    result.after = in.word();
    result.episode = in.word();
    result.number = in.word();
    result.lost = in.word();
    const std::uint32_t rows = in.word();
    result.alarm = in.word();
    for (int unused = 0; unused < 3; ++unused) in.word();

    const std::uint64_t padded = (std::uint64_t{row_bytes} + 3) / 4 * 4;
    const std::uint64_t row_size = 4 * std::uint64_t{words} + padded;
    const std::uint64_t content = bytes.size() - kLeast;
    const bool fits = words > 0 && row_bytes > 0 && rows > 0 && result.alarm < rows &&
                      row_size <= content / rows && content - rows * row_size < 32;
    if (!fits) return damaged("contradicts itself: its rows are not as long as its head says");
    for (std::uint32_t i = 0; i < rows; ++i) {
        Incident::Row& row = result.rows.emplace_back();
        row.step = in.word();
        for (std::uint32_t w = 1; w < words; ++w) row.figures.push_back(in.word());
        for (std::uint64_t b = 0; b < padded; ++b) {
            const std::uint8_t byte = in.byte();
            if (b < row_bytes) row.bytes.push_back(byte);
        }
    }
    return result;
}

}  // namespace etlc::recordings
