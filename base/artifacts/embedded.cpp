#include "artifacts/embedded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "artifacts/file.hpp"
#include "data/arrays/array.hpp"
#include "data/files/hash.hpp"
#include "data/text/text.hpp"

namespace etlc::embedded {
namespace {

using artifacts::Hash;
using data::in_quotes;
using diag::Code;

const artifacts::Kind kKind{"embedded.json",
                            "etlc embed",
                            1,
                            Code::malformed_embedded,
                            Code::unknown_embedded_format,
                            Code::invalid_embedded,
                            Code::unreadable_data_file};

/// Describes an encoder. `array` names its embeddings of the reference frames in an archive that is
/// written.
template <class Archive>
void encoder_members(Archive& archive, auto& encoder, const std::string& array) {
    archive("declaration", encoder.declaration);
    archive("model", encoder.model, Hash{});
    archive("settings", encoder.settings);
    archive("kind", encoder.kind);
    if constexpr (Archive::kReads)
        if (encoder.kind != kCommand && !encoder.kind.starts_with(kOnnxRuntime))
            archive.refuse("kind", fmt::format("'{}', or '{}' and its version", kCommand,
                                               kOnnxRuntime.substr(0, kOnnxRuntime.size() - 1)));
    std::uint64_t dimension = encoder.dimension;
    archive("dimension", dimension);
    std::string found = fingerprint(encoder);
    archive("fingerprint", found, Hash{});
    const std::uint64_t columns = encoder.references.size() / kReferenceFrames;
    const auto shape = archive(
        "references", artifacts::Array{array, {kReferenceFrames, columns}, "frames x dimension"},
        encoder.references);
    if constexpr (Archive::kReads) {
        encoder.dimension = static_cast<std::uint32_t>(
            std::min<std::uint64_t>(dimension, std::numeric_limits<std::uint32_t>::max()));
        if (found != fingerprint(encoder))
            archive.refuse(
                fmt::format("{} is {}, expected {}, which follows from the fields beside "
                            "it",
                            in_quotes(archive.place("fingerprint")), in_quotes(found),
                            in_quotes(fingerprint(encoder))));
        const std::vector<std::uint64_t> expected = {kReferenceFrames, encoder.dimension};
        if (shape != expected)
            archive.refuse(fmt::format("{} has the shape {} x {}, expected {} x {}",
                                       in_quotes(archive.place("references")), shape[0], shape[1],
                                       expected[0], expected[1]));
    }
}

/// Describes an entry. `array` names its matrix in an archive that is written.
template <class Archive>
void entry_members(Archive& archive, auto& entry, const std::string& array, const File& file) {
    archive("encoder", entry.encoder);
    if constexpr (Archive::kReads)
        if (!file.encoders.contains(entry.encoder))
            archive.refuse(fmt::format("{} is {}, expected one of 'encoders'",
                                       in_quotes(archive.place("encoder")),
                                       in_quotes(entry.encoder)));
    const auto shape =
        archive("array", artifacts::Array{array, {entry.rows, entry.columns}, "rows x dimension"},
                entry.matrix);
    archive("sources", entry.sources, "an array of files", [](auto& one, auto& source) {
        one("path", source.path);
        one("hash", source.hash, Hash{});
    });
    if constexpr (Archive::kReads) {
        entry.rows = static_cast<std::uint32_t>(shape[0]);
        entry.columns = static_cast<std::uint32_t>(shape[1]);
        entry.hash = data::content_hash({entry.rows, entry.columns}, entry.matrix);
    }
}

template <class Archive>
void file_members(Archive& archive, auto& file) {
    std::size_t encoders = 0;
    std::size_t entries = 0;
    archive("spec", file.spec);
    archive("encoders", file.encoders, [&](auto& one, const std::string&, auto& encoder) {
        encoder_members(one, encoder, fmt::format("references-{}", ++encoders));
    });
    archive("entries", file.entries, [&](auto& one, const std::string&, auto& entry) {
        entry_members(one, entry, fmt::format("rows-{}", ++entries), file);
    });
    archive("etlc", file.etlc);
}

constexpr auto kMembers = [](auto& archive, auto& file) { file_members(archive, file); };

/// Statements of an episode about its embeddings.
struct Said {
    Marks marks;
    Origins origins;
};

constexpr auto kSaidMembers = [](auto& archive, auto& said) {
    archive("inputs", said.marks, Hash{});
    archive("origins", said.origins, Hash{}, artifacts::Presence::where_any);
};

diag::Result<Said> said_in(const std::string& path) {
    const auto archive = data::Archive::open(path);
    if (!archive) return Said{};  // reading its arrays reports what is wrong
    if (!archive->has_file(kKind.member)) return Said{};
    Said said;
    const auto failure = artifacts::read_description(kKind, *archive, [&](artifacts::Reader& root) {
        root.read_file([&](auto& members) { kSaidMembers(members, said); });
    });
    if (failure) return *failure;
    return said;
}

}  // namespace

double relative_difference(const float* z, const float* r, std::size_t elements) {
    double difference = 0, length = 0;
    for (std::size_t i = 0; i < elements; ++i) {
        difference += (double{z[i]} - r[i]) * (double{z[i]} - r[i]);
        length += double{r[i]} * r[i];
    }
    const double relative = std::sqrt(difference / (length > 0 ? length : 1));
    return std::isfinite(relative) ? relative : std::numeric_limits<double>::infinity();
}

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
    for (unsigned minor = 13; minor < 100; ++minor)
        for (unsigned patch = 0; patch < 5; ++patch) {
            const std::string kind = fmt::format("{}1.{}.{}", kOnnxRuntime, minor, patch);
            add(kind, kind);
        }
    return found;
}

std::string default_path(const std::string& spec_path) {
    return artifacts::path_beside(spec_path, ".embedded.npz");
}

diag::Result<File> read(const std::string& path) {
    return data::within_memory(
        [&] { return artifacts::read_archive<File>(kKind, path, kMembers); });
}

std::string write(const File& file) {
    return artifacts::archive_bytes(kKind, file, kMembers);
}

diag::Result<Marks> read_marks(const std::string& path) {
    if (!path.ends_with(".npz")) return Marks{};
    auto said = data::within_memory([&] { return said_in(path); });
    if (!said) return said.failure();
    return std::move(said->marks);
}

Origins read_origins(const std::string& path) {
    auto said = data::within_memory([&] { return said_in(path); });
    return said ? std::move(said->origins) : Origins{};
}

std::string write_marks(const Marks& marks, const Origins& origins) {
    const Said said{marks, origins};
    return artifacts::file_text(kKind.format, nullptr,
                                [&](auto& members) { kSaidMembers(members, said); });
}

}  // namespace etlc::embedded
