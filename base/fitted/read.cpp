#include <fmt/format.h>

#include <algorithm>

#include "data/arrays/archive.hpp"
#include "data/arrays/array.hpp"
#include "data/files/file.hpp"
#include "data/text/quote.hpp"
#include "fitted/fitted.hpp"
#include "thresholds/described.hpp"
#include "thresholds/items.hpp"

namespace etlc::fitted {
namespace {

using data::in_quotes;
using diag::Code;
using diag::Failure;
using thresholds::Json;

const thresholds::Description kDescription{"fitted.json", "etlc fit", Code::malformed_fitted,
                                           Code::unknown_fitted_format, Code::invalid_fitted};

bool is_name(const std::string& text) {
    constexpr std::size_t kLongest = 1000;
    const auto letter = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    };
    const auto inner = [&](char c) { return letter(c) || (c >= '0' && c <= '9'); };
    return !text.empty() && text.size() <= kLongest && letter(text[0]) &&
           std::all_of(text.begin(), text.end(), inner);
}

/// The description and the arrays that it names to File.
class Reader : private thresholds::DescribedArrays {
public:
    Reader(const data::Archive& archive, thresholds::Items& items)
        : DescribedArrays(archive, kDescription), items_(items) {}

    diag::Result<File> read(const Json& root, const std::string& path) {
        File file;
        file.path = path;
        if (root.kind != Json::Kind::object) {
            fail("", root, "an object");
            return *failure_;
        }
        file.format = format(root, thresholds::kFormat);
        check_keys(root, "",
                   {"format", "spec", "entries", "episodes", "recordings", "allowances", "etlc"});
        file.spec = text(root, "", "spec");
        file.etlc = text(root, "", "etlc");
        const Json* entries = member(root, "", "entries", Json::Kind::object, "an object");
        for (std::size_t i = 0; entries != nullptr && i < entries->keys.size() && !failure_; ++i)
            file.entries.emplace(entries->keys[i], entry(entries->items[i], entries->keys[i]));
        file.episodes = episodes(root, "", items_);
        file.recordings = recordings(root, items_);
        if (root.find("allowances") != nullptr) file.allowances = allowances(root);
        if (failure_) return *failure_;
        return file;
    }

private:
    Entry entry(const Json& json, const std::string& name) {
        Entry result;
        result.name = name;
        const std::string path = "entries." + name;
        if (json.kind != Json::Kind::object) {
            fail(path, json, "an object");
            return result;
        }
        check_keys(json, path,
                   {"declaration", "of", "truth", "reads", "array", "offset", "frames", "medoids"});
        result.declaration = text(json, path, "declaration");
        if (!failure_ && name != result.declaration && !is_name(name))
            failure_ = Failure{Code::invalid_fitted,
                               fmt::format("{} is no name of a projection or target, nor the "
                                           "declaration of a metric",
                                           in_quotes(path))};
        result.of = text(json, path, "of");
        result.truth = text(json, path, "truth");
        result.reads = texts(json, path, "reads");
        result.frames = count(json, path, "frames");
        read_matrix(result, text(json, path, "array"));
        if (json.find("offset") != nullptr) read_offset(result, text(json, path, "offset"));
        if (json.find("medoids") != nullptr) read_medoids(result, json, path);
        if (!failure_) result.hash = content_hash(result);
        return result;
    }

    void read_matrix(Entry& entry, const std::string& key) {
        auto array = floats(key, 2, "rows x dimension");
        if (failure_) return;
        entry.rows = static_cast<std::uint32_t>(array.shape[0]);
        entry.columns = static_cast<std::uint32_t>(array.shape[1]);
        entry.matrix = std::move(array.values);
    }

    void read_offset(Entry& entry, const std::string& key) {
        auto array = floats(key, 1, "dimension");
        if (failure_) return;
        entry.offset = std::move(array.values);
        if (entry.offset.size() == entry.columns) return;
        failure_ = Failure{Code::invalid_fitted,
                           fmt::format("array {} has {}, expected {}, as many as the columns of "
                                       "its matrix",
                                       in_quotes(key), diag::counted(entry.offset.size(), "number"),
                                       entry.columns)};
    }

    void read_medoids(Entry& entry, const Json& json, const std::string& path) {
        const Json* array =
            member(json, path, "medoids", Json::Kind::array, "an array with a frame a row");
        if (array != nullptr && array->items.size() != entry.rows)
            fail(path + ".medoids", *array,
                 fmt::format("one of {}, as many as rows", diag::counted(entry.rows, "frame")));
        for (std::size_t i = 0; array != nullptr && i < array->items.size() && !failure_; ++i) {
            const Json& frame = array->items[i];
            const std::string place = fmt::format("{}.medoids[{}]", path, i);
            if (frame.kind != Json::Kind::object) {
                fail(place, frame, "an object");
                return;
            }
            check_keys(frame, place, {"episode", "step"});
            const Json* episode =
                member(frame, place, "episode", Json::Kind::string, "a content hash");
            if (episode == nullptr) return;
            entry.medoids.push_back(
                {hash(*episode, place + ".episode"), count(frame, place, "step")});
        }
    }

    thresholds::Items& items_;
};

diag::Result<File> read_all(const data::ArchivePlace& place, const std::string& path) {
    const auto archive = data::Archive::open(place);
    if (!archive) return archive.failure();
    thresholds::Items items(kDescription.invalid);
    const auto root = thresholds::read_description(*archive, kDescription, items.takers());
    if (const auto twice = items.twice()) return *twice;
    if (!root) return root.failure();
    return Reader(*archive, items).read(*root, path);
}

diag::Result<File> read_from(const data::ArchivePlace& place, const std::string& path) {
    try {
        return read_all(place, path);
    } catch (const data::SpillError& error) {
        return Failure{Code::unreadable_data_file, error.what()};
    }
}

}  // namespace

std::string content_hash(const Entry& entry) {
    if (entry.offset.empty()) return data::content_hash({entry.rows, entry.columns}, entry.matrix);
    std::vector<float> all = entry.matrix;
    all.insert(all.end(), entry.offset.begin(), entry.offset.end());
    return data::content_hash({std::uint64_t{entry.rows} + 1, entry.columns}, all);
}

std::string default_path(const std::string& spec_path) {
    return thresholds::path_beside(spec_path, ".fitted.npz");
}

diag::Result<File> read(const std::string& path) {
    return data::within_memory([&] { return read_from({path, {}, false}, path); });
}

diag::Result<File> parse(std::string_view bytes, const std::string& path) {
    return read_from({{}, bytes, true}, path);
}

}  // namespace etlc::fitted
