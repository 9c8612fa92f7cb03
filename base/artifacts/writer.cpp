#include "artifacts/writer.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "data/files/hash.hpp"

namespace etlc::artifacts {
namespace {

/// Returns the shortest decimal text that reads back to the same bits. Infinities are texts, since
/// JSON has no numbers for them.
template <class Number>
std::string text_of(Number value) {
    if (value == 0 && std::signbit(value))
        return "-0.0";  // -0 is an integer to JSON readers, and has no sign
    if (std::isinf(value)) return value > 0 ? "\"inf\"" : "\"-inf\"";
    std::array<char, 64> buffer;
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), end};
}

std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

void Writer::begin(const std::string& key) {
    const char* const separator = is_empty_ ? "{" : ",";
    if (in_line_)
        to_.add(fmt::format("{} {}: ", separator, quoted(key)));
    else
        to_.add(fmt::format("{}\n{:{}}{}: ", separator, "", indent_ + 2, quoted(key)));
    is_empty_ = false;
}

void Writer::end() {
    if (is_empty_)
        to_.add("{}");
    else if (in_line_)
        to_.add(" }");
    else
        to_.add(fmt::format("\n{:{}}}}", "", indent_));
}

void Writer::write(const std::string& key, std::string_view json) {
    begin(key);
    to_.add(json);
}

void Writer::write_rows(const std::string& key, std::size_t size,
                        const std::function<void(std::size_t)>& write_row) {
    if (size == 0) return write(key, "[]");
    begin(key);
    for (std::size_t i = 0; i < size; ++i) {
        to_.add(fmt::format("{}\n{:{}}", i > 0 ? "," : "[", "", indent_ + 4));
        write_row(i);
    }
    to_.add(fmt::format("\n{:{}}]", "", indent_ + 2));
}

void Writer::operator()(const std::string& key, const std::string& text) {
    write(key, quoted(text));
}

void Writer::operator()(const std::string& key, std::uint64_t hash, Hash) {
    (*this)(key, data::hash_text(hash));
}

void Writer::operator()(const std::string& key, const std::string& number, const Decimal&) {
    if (!number.empty()) write(key, number);
}

void Writer::operator()(const std::string& key, float number, OrInfinite /*infinite*/) {
    write(key, text_of(number));
}

void Writer::operator()(const std::string& key, const std::map<std::string, std::string>& texts,
                        Presence presence) {
    if (texts.empty() && presence == Presence::where_any) return;
    begin(key);
    Writer all(to_, indent_ + 2);
    for (const auto& [name, text] : texts) all(name, text);
    all.end();
}

void Writer::operator()(const std::string& key, const std::vector<double>& scores,
                        Presence presence) {
    if (scores.empty() && presence == Presence::where_any) return;
    write(key, "[");
    for (std::size_t i = 0; i < scores.size(); ++i)
        to_.add((i > 0 ? ", " : "") + text_of(scores[i]));
    to_.add("]");
}

void Writer::operator()(const std::string& key, const std::vector<std::uint64_t>& episodes,
                        Presence) {
    write_rows(key, episodes.size(),
               [&](std::size_t i) { to_.add('"' + data::hash_text(episodes[i]) + '"'); });
}

/// Writes for each episode and input the hash, a colon and the sketch, eight digits a unit; for an
/// embedding then what its samples tell.
void Writer::operator()(const std::string& key, const data::KnownEpisodes& recordings,
                        Presence presence) {
    if (recordings.empty() && presence == Presence::where_any) return;
    begin(key);
    Writer all(to_, indent_ + 2);
    recordings.for_each([&](std::uint64_t hash, const data::EpisodeContent& content) {
        std::map<std::string, std::string> inputs;
        for (const auto& [name, of_input] : content) {
            std::string& digits = inputs[name] = of_input.hash + ":";
            const auto add = [&](const data::Sketch& units) {
                for (const std::uint32_t unit : units)
                    fmt::format_to(std::back_inserter(digits), "{:08x}", unit);
            };
            add(of_input.sketch);
            if (of_input.samples == data::Samples::apart) digits += data::kApart;
            if (of_input.samples != data::Samples::recurring) continue;
            digits += data::kRecurring;
            add(of_input.changes);
        }
        all(data::hash_text(hash), inputs, Presence::always);
    });
    all.end();
}

std::vector<std::uint64_t> Writer::operator()(const std::string& key, const Array& array,
                                              const std::vector<float>& values, Presence presence) {
    if (values.empty() && presence == Presence::where_any) return {};
    (*this)(key, array.name);
    arrays_->push_back({array.name + ".npy", data::npy_bytes(array.shape, values)});
    return array.shape;
}

}  // namespace etlc::artifacts
