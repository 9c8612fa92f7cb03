#include <fmt/format.h>

#include "data/arrays/npz_writer.hpp"
#include "data/files/hash.hpp"
#include "fitted/fitted.hpp"
#include "thresholds/fields.hpp"

namespace etlc::fitted {
namespace {

using thresholds::json_text;

std::string medoids(const std::vector<Frame>& frames) {
    std::string result = "[";
    for (const Frame& frame : frames)
        result += fmt::format("{}\n        {{ \"episode\": {}, \"step\": {} }}",
                              result.size() > 1 ? "," : "",
                              json_text(data::hash_text(frame.episode)), frame.step);
    return result + "\n      ]";
}

std::string description_of(const Entry& entry, const std::string& array) {
    std::string result = "{";
    const auto line = [&](const std::string& key, const std::string& value) {
        result += fmt::format("{}\n      \"{}\": {}", result.size() > 1 ? "," : "", key, value);
    };
    line("declaration", json_text(entry.declaration));
    line("of", json_text(entry.of));
    line("truth", json_text(entry.truth));
    if (!entry.reads.empty()) line("reads", thresholds::json_texts(entry.reads, 6));
    line("array", json_text(array));
    if (!entry.offset.empty()) line("offset", json_text(array + "-offset"));
    line("frames", std::to_string(entry.frames));
    if (!entry.medoids.empty()) line("medoids", medoids(entry.medoids));
    return result + "\n    }";
}

}  // namespace

std::string write(const File& file) {
    std::map<std::string, std::string> entries;
    std::vector<data::ArchiveMember> members(1);
    std::size_t metrics = 0;
    for (const auto& [name, entry] : file.entries) {
        const bool is_metric = name == entry.declaration;
        const std::string array = is_metric ? fmt::format("metric-{}", ++metrics) : name;
        entries[name] = description_of(entry, array);
        members.push_back(
            {array + ".npy", data::npy_bytes({entry.rows, entry.columns}, entry.matrix)});
        if (!entry.offset.empty())
            members.push_back(
                {array + "-offset.npy", data::npy_bytes({entry.columns}, entry.offset)});
    }
    std::string description = fmt::format("{{\n  \"format\": {},\n", file.format);
    const auto line = [&](const std::string& key, const std::string& value) {
        description += fmt::format("  \"{}\": {},\n", key, value);
    };
    line("spec", json_text(file.spec));
    line("entries", thresholds::json_object(entries, 2));
    thresholds::Pieces to([&](std::string_view piece) {
        description += piece;
        return true;
    });
    to.add("  \"episodes\": ");
    thresholds::write_episodes(file.episodes, 2, to);
    to.add(",\n  \"recordings\": ");
    thresholds::write_recordings(file.recordings, to);
    to.add(",\n");
    to.finish();
    if (!file.allowances.empty()) line("allowances", thresholds::json_allowances(file.allowances));
    description += fmt::format("  \"etlc\": {}\n}}\n", json_text(file.etlc));
    members.front() = {"fitted.json", std::move(description)};
    return data::npz_bytes(members);
}

}  // namespace etlc::fitted
