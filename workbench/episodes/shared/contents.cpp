#include "episodes/shared/contents.hpp"

#include <optional>
#include <utility>

#include "data/files/atomic_file.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "data/recordings/open.hpp"
#include "data/spill/pack.hpp"

namespace etlc::episodes {

namespace {

using diag::Code;

constexpr std::uint64_t kLargestContents = std::uint64_t{1} << 40U;

struct Kept {
    std::vector<std::string> episodes;
    std::vector<std::uint64_t> contents;
};

template <class Archive>
void fields(Archive& archive, Kept& kept) {
    archive(kept.episodes, kept.contents);
}

std::optional<Kept> read(const std::string& path) {
    const auto bytes = data::read_file(path, kLargestContents, Code::unreadable_part);
    return bytes ? data::unpacked<Kept>(*bytes) : std::nullopt;
}

}  // namespace

std::uint64_t content_of(const std::string& episode) {
    const std::string file = data::trace_file(episode);
    return data::xxh64(data::ends_of_file(file) + episode.substr(file.size()));
}

std::vector<std::uint64_t> contents_of(const std::vector<std::string>& episodes,
                                       const std::string& kept) {
    if (!kept.empty())
        if (auto found = read(kept);
            found && found->episodes == episodes && found->contents.size() == episodes.size())
            return std::move(found->contents);
    std::vector<std::uint64_t> contents;
    contents.reserve(episodes.size());
    for (const std::string& episode : episodes) contents.push_back(content_of(episode));
    // Where it cannot be written, the next process looks at the episodes again.
    if (!kept.empty())
        static_cast<void>(data::write_file_atomically(kept, data::packed(Kept{episodes, contents}),
                                                      Code::unwritable_output));
    return contents;
}

}  // namespace etlc::episodes
