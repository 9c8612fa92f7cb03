#include <fmt/format.h>

#include "data/arrays/archive.hpp"
#include "data/arrays/array.hpp"
#include "data/arrays/npy.hpp"
#include "data/files/file.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

/// The key asked for; without one, the only key there is.
diag::Result<std::string> choose(const Archive& archive, const std::string& key) {
    if (!key.empty()) return key;
    if (archive.keys().empty()) return Failure{Code::no_such_array, "holds no arrays"};
    if (archive.keys().size() > 1)
        return Failure{Code::no_such_array,
                       fmt::format("holds {} arrays, {}; expected the key of one of them",
                                   archive.keys().size(), listed(archive.keys()))};
    return archive.keys().front();
}

diag::Result<Array> read_from(const ArchivePlace& place, const std::string& key) {
    const auto archive = Archive::open(place);
    if (!archive) return archive.failure();
    const auto chosen = choose(*archive, key);
    if (!chosen) return chosen.failure();
    const auto member = archive->member(*chosen);
    if (!member) return member.failure();
    auto array = read_npy_from(**member);
    if (!array) return in_array(array.failure(), *chosen);
    return array;
}

}  // namespace

diag::Result<Array> read_npz(const std::string& path, const std::string& key) {
    return read_from({path, {}, false}, key);
}

diag::Result<Array> parse_npz(std::string_view bytes, const std::string& key) {
    return read_from({{}, bytes, true}, key);
}

diag::Result<Array> read_array(const std::string& path, const std::string& key) {
    if (path.ends_with(".npz")) return within_memory([&] { return read_npz(path, key); });
    if (!path.ends_with(".npy"))
        return Failure{Code::unknown_data_format,
                       "unknown kind of data file, expected .npy or .npz"};
    if (!key.empty())
        return Failure{
            Code::key_without_archive,
            fmt::format("an .npy file holds one array without a name, so the key {} has no meaning",
                        in_quotes(key))};
    return within_memory([&] { return read_npy(path); });
}

}  // namespace etlc::data
