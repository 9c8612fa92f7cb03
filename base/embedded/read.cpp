#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "data/arrays/archive.hpp"
#include "data/arrays/array.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "data/text/quote.hpp"
#include "embedded/embedded.hpp"
#include "thresholds/described.hpp"

namespace etlc::embedded {
namespace {

using data::in_quotes;
using diag::Code;
using diag::Failure;
using thresholds::Json;

const thresholds::Description kDescription{"embedded.json", "etlc embed", Code::malformed_embedded,
                                           Code::unknown_embedded_format, Code::invalid_embedded};

/// The description and the arrays that it names to File.
class Reader : private thresholds::DescribedArrays {
public:
    explicit Reader(const data::Archive& archive) : DescribedArrays(archive, kDescription) {}

    diag::Result<File> read(const Json& root, const std::string& path) {
        File file;
        file.path = path;
        if (!begin(root, {"format", "spec", "encoders", "entries", "etlc"})) return *failure_;
        file.spec = text(root, "", "spec");
        file.etlc = text(root, "", "etlc");
        const Json* encoders = member(root, "", "encoders", Json::Kind::object, "an object");
        for (std::size_t i = 0; encoders != nullptr && i < encoders->keys.size() && !failure_; ++i)
            file.encoders.emplace(encoders->keys[i],
                                  encoder(encoders->items[i], "encoders." + encoders->keys[i]));
        const Json* entries = member(root, "", "entries", Json::Kind::object, "an object");
        for (std::size_t i = 0; entries != nullptr && i < entries->keys.size() && !failure_; ++i)
            file.entries.emplace(entries->keys[i],
                                 entry(entries->items[i], "entries." + entries->keys[i], file));
        if (failure_) return *failure_;
        return file;
    }

    diag::Result<Marks> read_marks(const Json& root) {
        Marks marks;
        if (!begin(root, {"format", "inputs"})) return *failure_;
        const Json* inputs = member(root, "", "inputs", Json::Kind::object, "an object");
        for (std::size_t i = 0; inputs != nullptr && i < inputs->keys.size() && !failure_; ++i)
            marks[inputs->keys[i]] =
                data::hash_text(hash(inputs->items[i], "inputs." + inputs->keys[i]));
        if (failure_) return *failure_;
        return marks;
    }

private:
    bool begin(const Json& root, const std::vector<std::string>& keys) {
        if (root.kind != Json::Kind::object) fail("", root, "an object");
        if (!failure_) format(root, 1);
        if (!failure_) check_keys(root, "", keys);
        return !failure_;
    }

    std::string hash_at(const Json& object, const std::string& path, const std::string& key) {
        const Json* value = member(object, path, key, Json::Kind::string, "a content hash");
        return value == nullptr ? "" : data::hash_text(hash(*value, path + "." + key));
    }

    Encoder encoder(const Json& json, const std::string& path) {
        Encoder result;
        if (json.kind != Json::Kind::object) {
            fail(path, json, "an object");
            return result;
        }
        check_keys(json, path,
                   {"declaration", "model", "settings", "kind", "dimension", "fingerprint"});
        result.declaration = text(json, path, "declaration");
        result.model = hash_at(json, path, "model");
        result.settings = text(json, path, "settings");
        result.kind = text(json, path, "kind");
        const std::uint64_t dimension = count(json, path, "dimension");
        result.dimension = static_cast<std::uint32_t>(
            std::min<std::uint64_t>(dimension, std::numeric_limits<std::uint32_t>::max()));
        const std::string found = hash_at(json, path, "fingerprint");
        if (!failure_ && found != fingerprint(result))
            failure_ = Failure{Code::invalid_embedded,
                               fmt::format("{} is {}, expected {}, which follows from the fields "
                                           "beside it",
                                           in_quotes(path + ".fingerprint"), in_quotes(found),
                                           in_quotes(fingerprint(result)))};
        return result;
    }

    Entry entry(const Json& json, const std::string& path, const File& file) {
        Entry result;
        if (json.kind != Json::Kind::object) {
            fail(path, json, "an object");
            return result;
        }
        check_keys(json, path, {"encoder", "array", "sources"});
        result.encoder = text(json, path, "encoder");
        if (!failure_ && !file.encoders.contains(result.encoder))
            failure_ =
                Failure{Code::invalid_embedded,
                        fmt::format("{} is {}, expected one of 'encoders'",
                                    in_quotes(path + ".encoder"), in_quotes(result.encoder))};
        Numbers numbers = floats(text(json, path, "array"), 2, "rows x dimension");
        read_sources(result, json, path);
        if (failure_) return result;
        result.rows = static_cast<std::uint32_t>(numbers.shape[0]);
        result.columns = static_cast<std::uint32_t>(numbers.shape[1]);
        result.matrix = std::move(numbers.values);
        result.hash = data::content_hash({result.rows, result.columns}, result.matrix);
        return result;
    }

    void read_sources(Entry& entry, const Json& json, const std::string& path) {
        const Json* array = member(json, path, "sources", Json::Kind::array, "an array of files");
        for (std::size_t i = 0; array != nullptr && i < array->items.size() && !failure_; ++i) {
            const std::string place = fmt::format("{}.sources[{}]", path, i);
            const Json& source = array->items[i];
            if (source.kind != Json::Kind::object) {
                fail(place, source, "an object");
                return;
            }
            check_keys(source, place, {"path", "hash"});
            const std::string name = text(source, place, "path");
            entry.sources.push_back({name, hash_at(source, place, "hash")});
        }
    }
};

diag::Result<File> read_from(const data::ArchivePlace& place, const std::string& path) {
    const auto archive = data::Archive::open(place);
    if (!archive) return archive.failure();
    const auto root = thresholds::read_description(*archive, kDescription);
    if (!root) return root.failure();
    return Reader(*archive).read(*root, path);
}

diag::Result<Marks> marks_from(const std::string& path) {
    const auto archive = data::Archive::open({path, {}, false});
    if (!archive) return Marks{};  // whoever reads its arrays says what is wrong with it
    if (!archive->has_file(kDescription.member)) return Marks{};
    const auto root = thresholds::read_description(*archive, kDescription);
    if (!root) return root.failure();
    return Reader(*archive).read_marks(*root);
}

}  // namespace

std::string fingerprint(const Encoder& encoder) {
    return fmt::format("{:016x}", data::xxh64(fmt::format("{}\n{}\n{}\n", encoder.model,
                                                          encoder.settings, encoder.kind)));
}

std::map<std::string, std::string> fingerprints_otherwise(const Encoder& encoder) {
    std::map<std::string, std::string> found;
    const auto add = [&](const std::string& kind, const std::string& name) {
        Encoder other = encoder;
        other.kind = kind;
        if (kind != encoder.kind) found[fingerprint(other)] = name;
    };
    add(std::string(kCommand), "a command");
    add("network", "OpenCV");
    for (unsigned minor = 13; minor < 100; ++minor)
        for (unsigned patch = 0; patch < 5; ++patch) {
            const std::string kind = fmt::format("{}1.{}.{}", kOnnxRuntime, minor, patch);
            add(kind, kind);
        }
    return found;
}

std::string default_path(const std::string& spec_path) {
    return thresholds::path_beside(spec_path, ".embedded.npz");
}

diag::Result<File> read(const std::string& path) {
    return data::within_memory([&] { return read_from({path, {}, false}, path); });
}

diag::Result<File> parse(std::string_view bytes, const std::string& path) {
    return read_from({{}, bytes, true}, path);
}

diag::Result<Marks> read_marks(const std::string& path) {
    if (!path.ends_with(".npz")) return Marks{};
    return data::within_memory([&] { return marks_from(path); });
}

}  // namespace etlc::embedded
