// Reads thresholds files, and the descriptions in files of fits and embeddings: any text gives an
// error, or a file that is the same after writing and reading it again, with every threshold
// consistent or reported.
#include <string>
#include <vector>

#include "artifacts/embedded.hpp"
#include "artifacts/fitted.hpp"
#include "artifacts/thresholds.hpp"
#include "check/guarantees/conformal.hpp"
#include "data/arrays/archive.hpp"
#include "fuzz_target.hpp"

namespace {

using namespace etlc;

/// Checks that the result of `read` for `bytes` is an error, or survives writing and reading.
template <class Read>
void read_archive(const std::vector<data::ArchiveMember>& members, Read read) {
    const auto file = read(fuzz::File(data::npz_bytes(members)).path());
    if (!file) return fuzz::require_printable(file.failure().message);
    const std::string written = write(*file);
    const auto again = read(fuzz::File(written).path());
    fuzz::require(static_cast<bool>(again), "what is written can be read");
    fuzz::require(write(*again) == written, "writing what was read changes nothing");
}

void read_fitted(const std::string& description) {
    read_archive({{"fitted.json", description},
                  {"Q.npy", data::npy_bytes({2, 2}, {1, 2, 3, 4})},
                  {"Q-offset.npy", data::npy_bytes({2}, {1, 2})}},
                 fitted::read);
}

void read_embedded(const std::string& description) {
    read_archive(
        {{"embedded.json", description}, {"rows-1.npy", data::npy_bytes({2, 2}, {1, 2, 3, 4})}},
        embedded::read);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    read_embedded(std::string(fuzz::text(bytes, size)));
    read_fitted(std::string(fuzz::text(bytes, size)));
    const auto file = thresholds::parse(std::string(fuzz::text(bytes, size)), "x");
    if (!file) {
        fuzz::require_printable(file.failure().message);
        return 0;
    }
    const std::string written = thresholds::write(*file);
    const auto again = thresholds::parse(written, "x");
    fuzz::require(static_cast<bool>(again), "what is written can be read");
    fuzz::require(thresholds::write(*again) == written, "writing what was read changes nothing");
    for (const auto& [name, entry] : file->predicates)
        if (const auto found =
                check::contradiction(entry, "predicates", true, file->episodes, file->groups))
            fuzz::require_printable(found->message);
    for (const auto& [name, entry] : file->monitors)
        if (const auto found =
                check::contradiction(entry, "monitors", false, entry.episodes, file->groups))
            fuzz::require_printable(found->message);
    return 0;
}
