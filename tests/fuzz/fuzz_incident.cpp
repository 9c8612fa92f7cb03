// Reads incidents: any bytes give an incident whose rows have one shape, or an error. The target
// corrects the checksum, because hardly any other input would pass it.
#include "data/files/hash.hpp"
#include "fuzz_target.hpp"
#include "recordings/incident.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* found, std::size_t size) {
    using namespace etlc;
    std::string bytes(fuzz::text(found, size));
    constexpr std::size_t kSum = 8;
    if (size > kSum) {
        const std::size_t content = size - kSum;
        const std::uint64_t sum = data::xxh64(std::string_view(bytes).substr(0, content));
        for (std::size_t i = 0; i < kSum; ++i)
            bytes[content + i] = static_cast<char>(sum >> (8 * i));
    }
    const auto incident = recordings::parse_incident(bytes);
    if (!incident) {
        fuzz::require_printable(incident.failure().message);
        return 0;
    }
    fuzz::require(incident->alarm < incident->rows.size(), "the alarm is one of the rows");
    for (const recordings::Incident::Row& row : incident->rows) {
        fuzz::require(row.figures.size() == incident->rows.front().figures.size(),
                      "rows have one shape");
        fuzz::require(row.bytes.size() == incident->rows.front().bytes.size(),
                      "rows have one shape");
    }
    return 0;
}
