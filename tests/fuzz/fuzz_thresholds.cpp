// Thresholds files: any text is a message, or a file that is the same after writing and reading it again.
#include <string>

#include "fuzz_target.hpp"
#include "thresholds/thresholds.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    using namespace etlc;
    const auto file = thresholds::parse(std::string(fuzz::text(bytes, size)), "x");
    if (!file) {
        fuzz::require_printable(file.failure().message);
        return 0;
    }
    const std::string written = thresholds::write(*file);
    const auto again = thresholds::parse(written, "x");
    fuzz::require(static_cast<bool>(again), "what is written can be read");
    fuzz::require(thresholds::write(*again) == written, "writing what was read changes nothing");
    return 0;
}
