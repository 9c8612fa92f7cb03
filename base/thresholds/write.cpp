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

void write_scores(const std::vector<double>& values, Pieces& to) {
    to.add("[");
    for (std::size_t i = 0; i < values.size(); ++i) to.add((i > 0 ? ", " : "") + number(values[i]));
    to.add("]");
}

void write_entry(const Entry& entry, const std::string& what, Pieces& to) {
    const auto line = [&](const std::string& key, const std::string& value,
                          std::string_view end = ",\n") {
        to.add(fmt::format("      \"{}\": {}{}", key, value, end));
    };
    to.add("{\n");
    line("method", json_text(entry.method));
    if (!entry.alpha.empty()) line("alpha", entry.alpha);
    line("epsilon", number(entry.epsilon));
    line("n", std::to_string(entry.n));
    line("k", std::to_string(entry.k));
    line("scores", "", "");
    write_scores(entry.scores, to);
    to.add(",\n");
    line(what, json_text(entry.predicate));
    line("truth", json_text(entry.truth));
    const bool of_monitor = !entry.against.empty();
    const std::string_view last = of_monitor ? ",\n" : "\n";
    line("targets", json_texts(entry.targets, 6), entry.reads.empty() ? last : ",\n");
    if (!entry.reads.empty()) line("reads", json_texts(entry.reads, 6), last);
    if (of_monitor) {
        line("against", json_text(entry.against));
        line("episodes", "", "");
        write_episodes(entry.episodes, 6, to);
        to.add("\n");
    }
    to.add("    }");
}

void write_entries(const std::map<std::string, Entry>& all, const std::string& what, Pieces& to) {
    if (all.empty()) return to.add("{}");
    std::string_view before = "{";
    for (const auto& [name, one] : all) {
        to.add(fmt::format("{}\n    {}: ", before, json_text(name)));
        write_entry(one, what, to);
        before = ",";
    }
    to.add("\n  }");
}

}  // namespace

bool write(const File& file, const Pieces::Take& take) {
    Pieces to(take);
    to.add(fmt::format("{{\n  \"format\": {},\n  \"spec\": {},\n  \"predicates\": ", file.format,
                       json_text(file.spec)));
    write_entries(file.predicates, "predicate", to);
    to.add(",\n  \"monitors\": ");
    write_entries(file.monitors, "formula", to);
    to.add(",\n  \"episodes\": ");
    write_episodes(file.episodes, 2, to);
    if (!file.recordings.empty()) {
        to.add(",\n  \"recordings\": ");
        write_recordings(file.recordings, to);
    }
    if (!file.allowances.empty())
        to.add(",\n  \"allowances\": " + json_allowances(file.allowances));
    to.add(fmt::format(",\n  \"etlc\": {}\n}}\n", json_text(file.etlc)));
    return to.finish();
}

std::string write(const File& file) {
    std::string all;
    write(file, [&](std::string_view piece) {
        all += piece;
        return true;
    });
    return all;
}

}  // namespace etlc::thresholds
