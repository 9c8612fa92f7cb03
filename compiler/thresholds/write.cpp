#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "thresholds/fields.hpp"
#include "thresholds/thresholds.hpp"

namespace etlc::thresholds {
namespace {

/// The shortest decimal text that reads back to the same bits; infinities as text, which JSON has
/// no number for.
template <class Number>
std::string number(Number value) {
    if (value == 0 && std::signbit(value))
        return "-0.0";  // -0 is an integer to JSON readers, and has no sign
    if (std::isinf(value)) return value > 0 ? "\"inf\"" : "\"-inf\"";
    std::array<char, 64> buffer;
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), end};
}

std::string scores(const std::vector<double>& values) {
    std::string result = "[";
    for (const double value : values) {
        if (result.size() > 1) result += ", ";
        result += number(value);
    }
    return result + "]";
}

std::string entry(const Entry& entry, const std::string& what) {
    std::map<std::string, std::string> targets;
    for (const auto& [name, hash] : entry.targets) targets[name] = json_text(hash);
    std::string result = "{\n";
    const auto line = [&](const std::string& key, const std::string& value, const char* end) {
        result += fmt::format("      \"{}\": {}{}\n", key, value, end);
    };
    line("method", json_text(entry.method), ",");
    if (!entry.alpha.empty()) line("alpha", entry.alpha, ",");
    line("epsilon", number(entry.epsilon), ",");
    line("n", std::to_string(entry.n), ",");
    line("k", std::to_string(entry.k), ",");
    line("scores", scores(entry.scores), ",");
    line(what, json_text(entry.predicate), ",");
    line("truth", json_text(entry.truth), ",");
    const bool of_monitor = !entry.against.empty();
    line("targets", json_object(targets, 6), of_monitor ? "," : "");
    if (of_monitor) {
        line("against", json_text(entry.against), ",");
        line("episodes", json_episodes(entry.episodes, 6), "");
    }
    return result + "    }";
}

std::string entries(const std::map<std::string, Entry>& all, const std::string& what) {
    std::map<std::string, std::string> members;
    for (const auto& [name, one] : all) members[name] = entry(one, what);
    return json_object(members, 2);
}

}  // namespace

std::string write(const File& file) {
    std::string result = "{\n  \"format\": 1,\n";
    const auto line = [&](const std::string& key, const std::string& value) {
        result += fmt::format("  \"{}\": {},\n", key, value);
    };
    line("spec", json_text(file.spec));
    line("predicates", entries(file.predicates, "predicate"));
    line("monitors", entries(file.monitors, "formula"));
    line("episodes", json_episodes(file.episodes, 2));
    if (!file.recordings.empty()) line("recordings", json_recordings(file.recordings));
    if (!file.allowances.empty()) line("allowances", json_allowances(file.allowances));
    return result + fmt::format("  \"etlc\": {}\n}}\n", json_text(file.etlc));
}

}  // namespace etlc::thresholds
