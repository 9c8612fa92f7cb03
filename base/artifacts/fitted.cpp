#include "artifacts/fitted.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "artifacts/file.hpp"
#include "data/arrays/array.hpp"
#include "data/text/text.hpp"

namespace etlc::fitted {
namespace {

using artifacts::Presence;
using data::in_quotes;
using diag::Code;

const artifacts::Kind kKind{"fitted.json",
                            "etlc fit",
                            thresholds::kFormat,
                            Code::malformed_fitted,
                            Code::unknown_fitted_format,
                            Code::invalid_fitted,
                            Code::unreadable_data_file};

bool is_name(const std::string& text) {
    constexpr std::size_t kLongest = 1000;
    const auto letter = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    };
    const auto inner = [&](char c) { return letter(c) || (c >= '0' && c <= '9'); };
    return !text.empty() && text.size() <= kLongest && letter(text[0]) &&
           std::all_of(text.begin(), text.end(), inner);
}

/// Describes an entry. `array` names its matrix in an archive that is written.
template <class Archive>
void members(Archive& archive, auto& entry, const std::string& array) {
    archive("declaration", entry.declaration);
    if constexpr (Archive::kReads)
        if (entry.name != entry.declaration && !is_name(entry.name))
            archive.refuse(fmt::format(
                "{} is neither the name of a projection or target nor the declaration of a metric",
                in_quotes(archive.place(""))));
    archive("reads", entry.reads, Presence::always);
    const auto shape =
        archive("array", artifacts::Array{array, {entry.rows, entry.columns}, "rows x dimension"},
                entry.matrix);
    if constexpr (Archive::kReads) {
        entry.rows = static_cast<std::uint32_t>(shape[0]);
        entry.columns = static_cast<std::uint32_t>(shape[1]);
    }
    archive("offset", artifacts::Array{array + "-offset", {entry.columns}, "dimension"},
            entry.offset, Presence::where_any);
    if constexpr (Archive::kReads)
        if (!entry.offset.empty() && entry.offset.size() != entry.columns)
            archive.refuse(fmt::format("array {} has {}, expected {}, one per column of its matrix",
                                       in_quotes(archive.find("offset")->text),
                                       diag::counted(entry.offset.size(), "number"),
                                       entry.columns));
    archive("frames", entry.frames);
    if constexpr (Archive::kReads) {
        const auto* rows = archive.find("medoids");
        if (rows != nullptr && rows->kind == artifacts::Json::Kind::array &&
            rows->items.size() != entry.rows)
            archive.refuse("medoids", fmt::format("one of {}, one per row",
                                                  diag::counted(entry.rows, "frame")));
    }
    archive(
        "medoids", entry.medoids, "an array with a frame a row",
        [](auto& one, auto& frame) {
            one("episode", frame.episode, artifacts::Hash{});
            one("step", frame.step);
        },
        Presence::where_any);
    if constexpr (Archive::kReads) entry.hash = content_hash(entry);
}

template <class Archive>
void file_members(Archive& archive, auto& file) {
    std::size_t metrics = 0;
    archive("spec", file.spec);
    archive("entries", file.entries, [&](auto& one, const std::string& name, auto& entry) {
        if constexpr (Archive::kReads) entry.name = name;
        const bool is_metric = name == entry.declaration;
        members(one, entry, is_metric ? fmt::format("metric-{}", ++metrics) : name);
    });
    archive("episodes", file.episodes, Presence::always);
    archive("recordings", file.recordings, Presence::always);
    artifacts::group_members(archive, file.groups);
    artifacts::allowance_members(archive, file.allowances);
    archive("etlc", file.etlc);
}

constexpr auto kMembers = [](auto& archive, auto& file) { file_members(archive, file); };

}  // namespace

std::string content_hash(const Entry& entry) {
    if (entry.offset.empty()) return data::content_hash({entry.rows, entry.columns}, entry.matrix);
    std::vector<float> all = entry.matrix;
    all.insert(all.end(), entry.offset.begin(), entry.offset.end());
    return data::content_hash({std::uint64_t{entry.rows} + 1, entry.columns}, all);
}

std::string default_path(const std::string& spec_path) {
    return artifacts::path_beside(spec_path, ".fitted.npz");
}

diag::Result<File> read(const std::string& path) {
    return data::within_memory(
        [&] { return artifacts::read_archive<File>(kKind, path, kMembers); });
}

std::string write(const File& file) {
    return artifacts::archive_bytes(kKind, file, kMembers);
}

}  // namespace etlc::fitted
