// Reads tables of labels: any bytes give rows, each of an episode, with an interval that is not
// empty, or an error with a place.
#include "episodes/labels/labels.hpp"
#include "fuzz_target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    using namespace etlc;
    const auto table = episodes::parse_labels(data::from_memory(fuzz::text(bytes, size)));
    if (!table) {
        fuzz::require_printable(table.failure().message);
        return 0;
    }
    std::uint32_t line = 1;
    for (const episodes::LabelRow& row : table->rows) {
        fuzz::require(row.line > line, "rows are in the order of their lines");
        line = row.line;
        fuzz::require(!row.episode.empty(), "a row names an episode");
        fuzz::require(!row.predicate.empty() || !row.group.empty(),
                      "a row labels a predicate or gives a group");
        fuzz::require(row.start >= 0 && row.start < row.end, "an interval is not empty");
    }
    return 0;
}
