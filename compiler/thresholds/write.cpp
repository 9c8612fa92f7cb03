#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

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

std::string text(const std::string& value) {
    return nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string scores(const std::vector<double>& values) {
    std::string result = "[";
    for (const double value : values) {
        if (result.size() > 1) result += ", ";
        result += number(value);
    }
    return result + "]";
}

/// `{ members }`, one a line; each is a key and a value that is already JSON.
std::string object(const std::map<std::string, std::string>& members, std::size_t indent) {
    if (members.empty()) return "{}";
    std::string result = "{";
    for (const auto& [key, value] : members)
        result += fmt::format("{}\n{:{}}{}: {}", result.size() > 1 ? "," : "", "", indent + 2,
                              text(key), value);
    return result + fmt::format("\n{:{}}}}", "", indent);
}

std::string episodes(const std::vector<std::string>& hashes, std::size_t indent) {
    if (hashes.empty()) return "[]";
    std::string result = "[";
    for (const std::string& hash : hashes)
        result +=
            fmt::format("{}\n{:{}}{}", result.size() > 1 ? "," : "", "", indent + 2, text(hash));
    return result + fmt::format("\n{:{}}]", "", indent);
}

/// Per episode and input, the hash, a colon and the sketch, eight digits a unit.
std::string recordings(const std::map<std::string, data::EpisodeContent>& all) {
    std::map<std::string, std::string> members;
    for (const auto& [hash, content] : all) {
        std::map<std::string, std::string> inputs;
        for (const auto& [name, of_input] : content) {
            std::string digits = of_input.hash + ":";
            for (const std::uint32_t unit : of_input.sketch)
                fmt::format_to(std::back_inserter(digits), "{:08x}", unit);
            inputs[name] = text(digits);
        }
        members[hash] = object(inputs, 4);
    }
    return object(members, 2);
}

std::string allowances(const std::vector<Allowance>& all) {
    std::string result = "[";
    for (const Allowance& allowance : all)
        result += fmt::format("{}\n    {{ \"reason\": {}, \"overlapping\": {}, \"leaked\": {} }}",
                              result.size() > 1 ? "," : "", text(allowance.reason),
                              allowance.overlapping, allowance.leaked);
    return result + "\n  ]";
}

std::string entry(const Entry& entry, const std::string& what) {
    std::map<std::string, std::string> targets;
    for (const auto& [name, hash] : entry.targets) targets[name] = text(hash);
    std::string result = "{\n";
    const auto line = [&](const std::string& key, const std::string& value, const char* end) {
        result += fmt::format("      \"{}\": {}{}\n", key, value, end);
    };
    line("method", text(entry.method), ",");
    if (!entry.alpha.empty()) line("alpha", entry.alpha, ",");
    line("epsilon", number(entry.epsilon), ",");
    line("n", std::to_string(entry.n), ",");
    line("k", std::to_string(entry.k), ",");
    line("scores", scores(entry.scores), ",");
    line(what, text(entry.predicate), ",");
    line("truth", text(entry.truth), ",");
    const bool of_monitor = !entry.against.empty();
    line("targets", object(targets, 6), of_monitor ? "," : "");
    if (of_monitor) {
        line("against", text(entry.against), ",");
        line("episodes", episodes(entry.episodes, 6), "");
    }
    return result + "    }";
}

std::string entries(const std::map<std::string, Entry>& all, const std::string& what) {
    std::map<std::string, std::string> members;
    for (const auto& [name, one] : all) members[name] = entry(one, what);
    return object(members, 2);
}

}  // namespace

std::string write(const File& file) {
    std::string result = "{\n  \"format\": 1,\n";
    const auto line = [&](const std::string& key, const std::string& value) {
        result += fmt::format("  \"{}\": {},\n", key, value);
    };
    line("spec", text(file.spec));
    line("predicates", entries(file.predicates, "predicate"));
    line("monitors", entries(file.monitors, "formula"));
    line("episodes", episodes(file.episodes, 2));
    if (!file.recordings.empty()) line("recordings", recordings(file.recordings));
    if (!file.allowances.empty()) line("allowances", allowances(file.allowances));
    return result + fmt::format("  \"etlc\": {}\n}}\n", text(file.etlc));
}

}  // namespace etlc::thresholds
