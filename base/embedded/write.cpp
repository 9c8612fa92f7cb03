#include <fmt/format.h>

#include "data/arrays/npz_writer.hpp"
#include "embedded/embedded.hpp"
#include "thresholds/fields.hpp"

namespace etlc::embedded {
namespace {

using thresholds::json_text;

/// An object on lines of its own, `indent` blanks deep.
std::string object(const std::vector<std::pair<std::string, std::string>>& fields,
                   std::size_t indent) {
    std::string result = "{";
    for (const auto& [key, value] : fields)
        result += fmt::format("{}\n{:{}}\"{}\": {}", result.size() > 1 ? "," : "", "", indent + 2,
                              key, value);
    return result + fmt::format("\n{:{}}}}", "", indent);
}

std::string text_of(const Encoder& encoder) {
    return object({{"declaration", json_text(encoder.declaration)},
                   {"model", json_text(encoder.model)},
                   {"settings", json_text(encoder.settings)},
                   {"kind", json_text(encoder.kind)},
                   {"dimension", std::to_string(encoder.dimension)},
                   {"fingerprint", json_text(fingerprint(encoder))}},
                  4);
}

std::string text_of(const Entry& entry, const std::string& array) {
    std::string sources = "[";
    for (const Source& source : entry.sources)
        sources += fmt::format("{}\n        {{ \"path\": {}, \"hash\": {} }}",
                               sources.size() > 1 ? "," : "", json_text(source.path),
                               json_text(source.hash));
    return object({{"encoder", json_text(entry.encoder)},
                   {"array", json_text(array)},
                   {"sources", sources + "\n      ]"}},
                  4);
}

}  // namespace

std::string write(const File& file) {
    std::map<std::string, std::string> encoders;
    for (const auto& [name, encoder] : file.encoders) encoders[name] = text_of(encoder);
    std::map<std::string, std::string> entries;
    std::vector<data::ArchiveMember> members(1);
    for (const auto& [text, entry] : file.entries) {
        const std::string array = fmt::format("rows-{}", members.size());
        entries[text] = text_of(entry, array);
        members.push_back(
            {array + ".npy", data::npy_bytes({entry.rows, entry.columns}, entry.matrix)});
    }
    members.front() = {"embedded.json", object({{"format", "1"},
                                                {"spec", json_text(file.spec)},
                                                {"encoders", thresholds::json_object(encoders, 2)},
                                                {"entries", thresholds::json_object(entries, 2)},
                                                {"etlc", json_text(file.etlc)}},
                                               0) +
                                            "\n"};
    return data::npz_bytes(members);
}

std::string write_marks(const Marks& marks) {
    std::map<std::string, std::string> inputs;
    for (const auto& [input, fingerprint] : marks) inputs[input] = json_text(fingerprint);
    return object({{"format", "1"}, {"inputs", thresholds::json_object(inputs, 2)}}, 0) + "\n";
}

}  // namespace etlc::embedded
