// Reads parts of results: any bytes give an error, or a part that is the same after writing and
// reading it again; its contents about episodes are read or refused. The bytes are read as a file,
// and again as the body of one, since few inputs have a valid checksum.
#include <string>

#include "calibrate/scores.hpp"
#include "calibrate/shift.hpp"
#include "evaluate/episode_scores.hpp"
#include "fuzz_target.hpp"

namespace {

using namespace etlc;

template <class T>
void read_result(const std::string& bytes) {
    if (const auto result = data::unpacked<T>(bytes))
        fuzz::require(data::packed(*result) == bytes, "writing a result changes nothing");
}

void read(const std::string& bytes) {
    const auto part = episodes::parse_part(bytes);
    if (!part) return fuzz::require_printable(part.failure().message);
    const auto again = episodes::parse_part(episodes::write(*part));
    fuzz::require(again && data::packed(*again) == data::packed(*part),
                  "writing what was read changes nothing");
    for (const auto& [place, result] : part->results) {
        read_result<calibrate::Demonstration>(result);
        read_result<calibrate::MonitorEpisode>(result);
        read_result<evaluate::EpisodeResult>(result);
    }
    diag::Sink sink;
    episodes::Joined all;
    if (all.add(*part, "x", sink) && all.is_complete(sink))
        for (std::size_t place = 0; place < part->episodes.size(); ++place)
            fuzz::require(all.result(place) == part->results.at(place),
                          "each episode has its result");
    else
        fuzz::require(sink.has_errors(), "what is not joined is reported");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string text(fuzz::text(bytes, size));
    read(text);
    read(episodes::as_file(text));
    return 0;
}
