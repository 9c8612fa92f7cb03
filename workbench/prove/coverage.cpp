#include "prove/coverage.hpp"

#include <exception>
#include <map>
#include <nlohmann/json.hpp>

namespace etlc::prove {

namespace {

/// Adds an instance of a line: templates have several.
void add(Line& line, const nlohmann::json& instance) {
    line.count += instance.at("count").get<std::uint64_t>();
    std::size_t way = 0;
    for (const nlohmann::json& branch : instance.at("branches")) {
        if (branch.at("throw").get<bool>()) continue;
        if (way == line.ways.size()) line.ways.push_back(0);
        line.ways[way++] += branch.at("count").get<std::uint64_t>();
    }
}

}  // namespace

std::optional<std::vector<Line>> coverage_of(const std::string& json, std::string_view name) {
    std::map<std::uint32_t, Line> lines;
    try {
        const auto all = nlohmann::json::parse(json);
        for (const nlohmann::json& file : all.at("files")) {
            if (!file.at("file").get<std::string>().ends_with(name)) continue;
            for (const nlohmann::json& instance : file.at("lines")) {
                const auto number = instance.at("line_number").get<std::uint32_t>();
                lines[number].number = number;
                add(lines[number], instance);
            }
        }
    } catch (const std::exception&) {  // no gcov, or another one
        return std::nullopt;
    }
    if (lines.empty()) return std::nullopt;
    std::vector<Line> result;
    for (auto& [number, line] : lines) result.push_back(std::move(line));
    return result;
}

}  // namespace etlc::prove
